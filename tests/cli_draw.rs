//! `nusselt draw` on the command line.
#![cfg(feature = "cli")]

mod common;

use common::program::Folder;

#[test]
fn the_cornell_box_is_drawn() {
    let folder = Folder::new("draw");
    let camera = "--eye 278,273,-800 --look-at 278,273,0 --up 0,1,0 --fov 40";
    let summary = folder.parsed(&format!("draw box.obj {camera} -o box.svg --hidden --json"));
    assert_eq!(summary["schema"], "nusselt.drawing/1");
    // Five walls, the lamp or its frame, two faces of each block at least.
    assert!(summary["regions"].as_u64().expect("a count") >= 9, "{summary}");
    assert!(summary["creases"].as_u64().expect("a count") > 8 && summary["hidden"].as_u64().expect("a count") > 4);
    let svg = folder.read("box.svg");
    assert!(svg.starts_with("<?xml") && svg.trim_end().ends_with("</svg>") && !svg.contains("NaN"));
    let text = folder.run(&format!("draw box.obj {camera} -o box.svg --fill white --size 400"), 0);
    assert!(text.contains("silhouettes") && text.contains("wrote"), "{text}");
}

#[test]
fn what_is_wrong_is_said_in_one_line() {
    let folder = Folder::new("draw-wrong");
    for (line, code, what) in [
        ("draw box.obj --eye 1,2,3 --fov 40 -o x.svg", 2, "--look-at"),
        ("draw box.obj --eye 1,2,3 --look-at 1,2,3 --fov 40 -o x.svg", 2, "--look-at is --eye"),
        ("draw box.obj --eye 1,2,3 --look-at 0,0,0 --fov 180 -o x.svg", 2, "below 180"),
        ("draw box.obj --eye 1,2,3 --look-at 0,0,0 --fov 40 -o x.png", 2, ".svg"),
        ("draw box.obj --eye 1,2,3 --look-at 0,0,0 --fov 40 --up 1,2,3 -o x.svg", 2, "--up"),
        ("draw box.obj --eye 1,2,3 --look-at 0,0,0 --fov 40 --crease 181 -o x.svg", 2, "0 to 180"),
        ("draw box.obj --eye 1,2,3 --look-at 0,0,0 --fov 40 --fill grey -o x.svg", 2, "shaded, flat and white"),
        ("draw none.obj --eye 1,2,3 --look-at 0,0,0 --fov 40 -o x.svg", 1, "none.obj"),
    ] {
        let error = folder.run(line, code);
        assert!(error.contains(what), "{line}: {error}");
    }
}
