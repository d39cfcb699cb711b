//! The layers of the crate: a module uses only those below it. Reads the `crate::` paths of the source.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// From the lowest to the highest; each may use those before it.
///
/// The verifiers come before what they verify, so that they cannot share anything with it.
const LAYERS: [&str; 16] = [
    "exact",
    "scene",
    "verify",
    "bsp",
    "bvh",
    "contour",
    "integral",
    "brdf",
    "factors",
    "radiosity",
    "picture",
    "hemicube",
    "render",
    "samples",
    "io",
    "testing",
];

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
fn used(code: &str) -> BTreeSet<String> {
    let mut modules = BTreeSet::new();
    for part in code.split("crate::").skip(1) {
        let names: String = match part.strip_prefix('{') {
            // Up to the brace that closes it, without what is in braces within.
            Some(list) => {
                let depths = list.chars().scan(1, |open, c| {
                    *open += i32::from(c == '{') - i32::from(c == '}');
                    (*open > 0).then_some((*open, c))
                });
                depths.filter(|(open, _)| *open == 1).map(|(_, c)| c).collect()
            }
            None => part.chars().take_while(|c| c.is_alphanumeric() || "_*".contains(*c)).collect(),
        };
        let names = names.split(',').map(|name| name.trim().split([':', ' ']).next().unwrap_or_default().to_owned());
        modules.extend(names.filter(|name| !name.is_empty()));
    }
    modules
}

/// The code of a file without comments, with paths that climb to the root by `super` written as `crate::`. `depth` is how
/// many modules the file is in, with its own.
fn code(text: &str, depth: usize) -> String {
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    lines.join("\n").replace(&"super::".repeat(depth), "crate::")
}

#[test]
fn modules_are_found_however_they_are_named() {
    let found = |text: &str, depth| used(&code(text, depth)).into_iter().collect::<Vec<_>>();
    assert_eq!(found("use crate::bsp;\nuse crate::exact::{Sign, Kernel};", 2), ["bsp", "exact"]);
    assert_eq!(
        found("use crate::{exact::{Sign, Kernel}, bsp::{a, b::{c}},\n contour as c};", 2),
        ["bsp", "contour", "exact"]
    );
    assert_eq!(found("use super::super::bsp::Order; use super::boxes;", 2), ["bsp"]);
    assert_eq!(
        found("// crate::bsp\nfn f(a: crate::scene::Scene, b: &crate::contour::Cell) {}", 2),
        ["contour", "scene"]
    );
    assert_eq!(found("use crate::*;", 2), ["*"]);
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
            let parents = file.strip_prefix(&root).unwrap().components().count() - 1;
            let depth = if file.file_name().is_some_and(|name| name == "mod.rs") { parents } else { parents + 1 };
            let code = code(&fs::read_to_string(&file).unwrap(), depth);
            assert!(!code.contains("crate as "), "{} gives the crate another name", file.display());
            for module in used(&code) {
                assert_ne!(module, "*", "{} uses everything", file.display());
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
