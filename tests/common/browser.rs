//! Pages shown in headless Chromium.

use super::program::Folder;
use std::path::Path;
use std::process::Command;

/// What becomes of a page in Chromium, if that is there; the page says `data-state="drawn"` when it is done.
pub(crate) fn shown(folder: &Folder, page: &str) -> Option<String> {
    let Some(browser) = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"]
        .into_iter()
        .find(|path| Path::new(path).exists())
    else {
        eprintln!("SKIPPED: there is no Chromium to show {page} with; install it to have the page tested");
        return None;
    };
    let profile = folder.path("profile");
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader"])
        .args(["--enable-unsafe-swiftshader", "--no-first-run", "--disable-background-networking", "--disable-quic"])
        .args(["--disable-component-update", "--disable-sync", "--virtual-time-budget=60000", "--dump-dom"])
        .args(["--window-size=640,480", "--force-device-scale-factor=1"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("file://{}", folder.path(page).display()))
        .output()
        .expect("the browser runs");
    let document = String::from_utf8_lossy(&output.stdout).into_owned();
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(document.contains("data-state=\"drawn\""), "{page}: {complaint}");
    Some(document)
}

/// The numbers that a page left under a name.
pub(crate) fn told(document: &str, name: &str) -> Vec<f64> {
    let rest = document.split(&format!("data-{name}=\"")).nth(1).unwrap_or_else(|| panic!("no {name}"));
    let numbers = rest.split('"').next().expect("its end");
    numbers.split(',').map(|x| x.parse().expect("a number")).collect()
}
