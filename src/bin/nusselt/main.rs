//! The command line program `nusselt`.
fn main() {}
