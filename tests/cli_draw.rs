//! `nusselt draw` on the command line.
#![cfg(feature = "cli")]

mod common;

use common::browser::{shown, told};
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

/// The window of the image plane may be very wide, and what is drawn very small in it.
#[test]
fn cameras_of_all_widths_draw() {
    let folder = Folder::new("draw-wide");
    for wide in ["--fov 40 --aspect 1e9", "--fov 40 --aspect 1e15", "--fov 40 --aspect 1e-9", "--fov 179.9999999"] {
        let line = format!("draw box.obj --eye 278,273,-800 --look-at 278,273,0 {wide} -o a.svg --json");
        assert!(folder.parsed(&line)["regions"].as_u64().expect("a count") > 0, "{wide}");
        let svg = folder.read("a.svg");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{wide}");
    }
}

/// A drawing without its lines, over a page of magenta, at several scales: the pixels in which some of that shows through between regions. In a closed
/// room there is no background.
const SCALES: &str = r#"<script>
const drawing = document.getElementById("drawing").textContent;
const shown = scale => new Promise(done => {
  const image = new Image();
  image.onload = () => done(image);
  const sized = drawing.replace(/width="([\d.]+)" height="([\d.]+)"/, (_, w, h) => `width="${w * scale}" height="${h * scale}"`);
  image.src = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(sized);
});
(async () => {
  const counts = [];
  for (const scale of [0.23, 0.7, 1, 1.37, 3]) {
    const image = await shown(scale);
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    // Not the margin, nor what is smoothed beside it.
    const margin = Math.ceil(MARGIN * scale) + 2;
    const { data } = context.getImageData(margin, margin, canvas.width - 2 * margin, canvas.height - 2 * margin);
    let magenta = 0;
    for (let k = 0; k < data.length; k += 4) magenta += data[k] > data[k + 1] + 40 && data[k + 2] > data[k + 1] + 40;
    counts.push(magenta);
  }
  document.body.dataset.magenta = counts;
  document.body.dataset.state = "drawn";
})();
</script>"#;

/// How much of a page of magenta is seen through a drawing without its lines, at several scales. `None` without a browser.
fn magenta(folder: &Folder, drawing: &str) -> Option<Vec<f64>> {
    let (fills, lines) = (r#"fill="white"/>"#, "</style>");
    assert!(drawing.contains(fills) && drawing.contains(lines));
    let bare = drawing
        .replacen(fills, r##"fill="#ff00ff"/>"##, 1)
        .replace(lines, ".hidden,.crease,.crossing,.border,.silhouette,.frame{display:none}</style>");
    let script = SCALES.replace("MARGIN", "20");
    let kept = format!(r#"<script type="text/plain" id="drawing">{bare}</script>"#);
    folder.write("page.html", format!("<!DOCTYPE html><html><body>{kept}{script}</body></html>"));
    Some(told(&shown(folder, "page.html")?, "magenta"))
}

#[test]
fn a_browser_shows_no_gaps_between_regions() {
    let folder = Folder::new("draw-gaps");
    folder.run("scene office --polygons 1000 --seed 3 -o office.obj", 0);
    folder.run("draw office.obj --eye 1,1,1.6 --look-at 4,3,0.8 --fov 80 --size 400 -o a.svg", 0);
    let drawing = folder.read("a.svg");
    assert!(!drawing.contains("class=\"background\""), "nothing else is seen through");
    let Some(seen) = magenta(&folder, &drawing) else { return };
    assert_eq!(seen, [0.0; 5]);
    // Regions that are not stroked do show gaps: the test sees them.
    let gaps = magenta(&folder, &drawing.replace(r#"stroke-width="1.2""#, r#"stroke-width="0""#)).expect("a browser");
    assert!(gaps.iter().all(|&count| count > 0.0), "{gaps:?}");
}

/// A convex polygon with a side of a tenth of a pixel, which Chromium does not fill wholly if it is all of a path, before a square.
#[test]
fn a_browser_shows_no_holes_in_regions() {
    let folder = Folder::new("draw-holes");
    folder.write(
        "a.obj",
        "v 889.1 -299.16 0\nv 889.54 -295.3 0\nv 889.55 -295.21 0\nv 879.02 -306.95 0\nv 877.43 -321.24 0\nv 886.23 -324.25 0\n\
         v 800 -200 -1\nv 1000 -200 -1\nv 1000 -400 -1\nv 800 -400 -1\nf 1 2 3 4 5 6\nf 7 8 9 10\n",
    );
    let camera = "--eye 885,-310,34.64101615137755 --look-at 885,-310,0 --up 0,1,0 --fov 60 --size 40";
    folder.run(&format!("draw a.obj {camera} -o a.svg"), 0);
    let Some(seen) = magenta(&folder, &folder.read("a.svg")) else { return };
    assert_eq!(seen, [0.0; 5]);
}
