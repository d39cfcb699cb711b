//! The layers of the crate: a module uses only those below it. Reads the `crate::` paths of the source.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// From the lowest to the highest; each may use those before it.
///
/// The verifiers come before what they verify, so that they cannot share anything with it.
const LAYERS: [&str; 10] =
    ["exact", "geometry", "scene", "verify", "bsp", "contour", "integral", "samples", "io", "testing"];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries: std::io::Result<Vec<_>> = fs::read_dir(folder).and_then(Iterator::collect);
    let mut entries: Vec<PathBuf> = entries.expect("a readable folder").iter().map(fs::DirEntry::path).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// The top-level modules named in `crate::` paths, with braces after `crate::` opened.
fn used(text: &str) -> BTreeSet<String> {
    let mut modules = BTreeSet::new();
    for part in text.split("crate::").skip(1) {
        let names = match part.strip_prefix('{') {
            Some(list) => list.split('}').next().unwrap_or_default().split(','),
            None => part.split([':', ';', ' ', '}', ',']).next().unwrap_or_default().split(','),
        };
        modules.extend(names.map(|name| name.trim().split(':').next().unwrap_or_default().to_owned()));
    }
    modules
}

#[test]
fn lower_layers_never_use_higher_ones() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut checked = 0;
    for (level, layer) in LAYERS.iter().enumerate() {
        let mut files = Vec::new();
        let folder = root.join(layer);
        if folder.is_dir() {
            sources(&folder, &mut files);
        }
        for file in files {
            // Tests may look down on the engine from anywhere.
            if file.file_stem().is_some_and(|stem| stem == "tests") {
                continue;
            }
            let text = fs::read_to_string(&file).unwrap();
            let code: String = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
            for module in used(code.split("#[cfg(test)] mod tests {").next().unwrap_or_default()) {
                let Some(other) = LAYERS.iter().position(|&name| name == module) else { continue };
                assert!(other <= level, "{} uses the higher layer {module}", file.display());
                checked += 1;
            }
        }
    }
    assert!(checked > 20, "only {checked} uses were found: the test no longer reads the source");
}

#[test]
fn every_module_has_its_layer() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for entry in fs::read_dir(root).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "bin" {
            assert!(LAYERS.contains(&name.as_str()), "src/{name} has no layer in this test");
        }
    }
}
