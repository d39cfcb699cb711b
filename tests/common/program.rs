//! The program, run in a folder of its own.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of its own for a test, with the Cornell box in it as `box.obj`; removed in the end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    /// `name` tells it from those of other tests.
    pub(crate) fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}", std::process::id()));
        // Left over from a run that was stopped.
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder for tests");
        let folder = Self(path);
        folder.run("scene cornell -o box.obj", 0);
        folder
    }

    /// Runs the program in the folder; checks the exit code, and that failures are one line.
    pub(crate) fn run(&self, line: &str, code: i32) -> String {
        let Output { status, stdout, stderr } = Command::new(env!("CARGO_BIN_EXE_nusselt"))
            .args(line.split_whitespace())
            .current_dir(&self.0)
            .output()
            .expect("the program runs");
        let [stdout, stderr] = [stdout, stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
        assert_eq!(status.code(), Some(code), "{line}\n{stdout}\n{stderr}");
        if code == 0 {
            return stdout;
        }
        assert_eq!(stdout, "", "{line}");
        assert!(stderr.starts_with("nusselt: ") && stderr.lines().count() == 1, "{line}: {stderr}");
        stderr
    }

    pub(crate) fn parsed(&self, line: &str) -> Value {
        serde_json::from_str(&self.run(line, 0)).expect("JSON")
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub(crate) fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).expect("JSON")
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).expect("writable");
    }

    pub(crate) fn exists(&self, name: &str) -> bool {
        self.path(name).exists()
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("written")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}
