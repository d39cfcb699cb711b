//! This program under callgrind.

use std::collections::BTreeMap;
use std::error::Error;
use std::process::{Command, Stdio};

/// What callgrind counted.
pub(crate) struct Profile {
    /// The sums of its events by their names: `Ir` are instructions executed.
    events: Vec<(String, u64)>,
    /// Instructions by function: its own, and with those of what it calls.
    pub(crate) functions: BTreeMap<String, [u64; 2]>,
}

impl Profile {
    /// The sum of an event.
    pub(crate) fn total(&self, event: &str) -> u64 {
        self.events.iter().find(|(name, _)| name == event).map_or(0, |(_, count)| *count)
    }
}

/// An error if there is no valgrind.
pub(crate) fn check() -> Result<(), Box<dyn Error>> {
    let version = Command::new("valgrind").arg("--version").stdout(Stdio::null()).status();
    if version.is_ok_and(|status| status.success()) {
        Ok(())
    } else {
        Err("this takes valgrind, which is not installed".into())
    }
}

/// Counts some work (see `work.rs`), with a simulation of caches if `with_caches`: a last one of 2 MiB, 16 ways.
pub(crate) fn count(work: &[&str], with_caches: bool) -> Result<Profile, Box<dyn Error>> {
    let out = std::env::temp_dir().join(format!("nusselt-callgrind-{}", std::process::id()));
    let mut command = Command::new("valgrind");
    command.args(["--quiet", "--tool=callgrind", "--toggle-collect=performance::work::counted*"]);
    command.arg(format!("--callgrind-out-file={}", out.display()));
    if with_caches {
        command.args(["--cache-sim=yes", "--LL=2097152,16,64"]);
    }
    let output = command.arg(std::env::current_exe()?).arg("work").args(work).output()?;
    let text = std::fs::read_to_string(&out);
    let _ = std::fs::remove_file(&out);
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("valgrind failed on {}: {}\n{said}", work.join(" "), output.status).into());
    }
    let profile = parse(&text?);
    if profile.total("Ir") == 0 { Err("callgrind counted nothing".into()) } else { Ok(profile) }
}

/// Reads callgrind's profile data format, version 1.
fn parse(text: &str) -> Profile {
    let (mut names, mut totals) = (Vec::new(), Vec::new());
    let mut functions: BTreeMap<String, [u64; 2]> = BTreeMap::new();
    // Names are there once; later only their numbers are.
    let mut known: BTreeMap<String, String> = BTreeMap::new();
    let mut name_of = |field: &str| {
        let (number, name) = field.split_once(' ').unwrap_or((field, ""));
        if !name.is_empty() {
            // Calls of a function within itself are told apart by a number.
            let (plain, _) = name.split_once('\'').unwrap_or((name, ""));
            known.insert(number.to_owned(), plain.to_owned());
        }
        known.get(number).cloned().unwrap_or_else(|| field.to_owned())
    };
    let (mut function, mut called, mut is_call) = (String::new(), String::new(), false);
    for line in text.lines() {
        if let Some(field) = line.strip_prefix("fn=") {
            function = name_of(field);
        } else if let Some(field) = line.strip_prefix("cfn=") {
            called = name_of(field);
        } else if line.starts_with("calls=") {
            is_call = true;
        } else if let Some(rest) = line.strip_prefix("events:") {
            names = rest.split_whitespace().map(str::to_owned).collect();
        } else if let Some(rest) = line.strip_prefix("totals:") {
            totals = rest.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        } else if line.starts_with(|c: char| c.is_ascii_digit() || "+-*".contains(c)) {
            let cost: u64 = line.split_whitespace().nth(1).and_then(|word| word.parse().ok()).unwrap_or(0);
            let [own, all] = functions.entry(function.clone()).or_default();
            if !is_call {
                *own += cost;
                *all += cost;
            } else if called != function {
                *all += cost;
            }
            is_call = false;
        }
    }
    Profile { events: names.into_iter().zip(totals).collect(), functions }
}
