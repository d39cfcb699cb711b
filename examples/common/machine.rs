//! What tables were measured on.

/// A sentence with the name of the processor and how many of it there are.
pub(crate) fn sentence() -> String {
    // Only Linux has it; elsewhere the architecture must do.
    let about = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name =
        about.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':').map(|(_, name)| name.trim()));
    let count = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    format!("Measured on {}, {count} at hand.", name.unwrap_or(std::env::consts::ARCH))
}
