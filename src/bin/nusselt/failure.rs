//! What ends the program, and how it is said.

use clap::error::ErrorKind;
use std::io::Write;

/// Why the program did not do what it was asked for.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The command line is wrong: exit code 2.
    Usage(String),
    /// The input or the work failed: exit code 1.
    Work(String),
}

/// Writes the one message to stderr.
pub(crate) fn report(failure: &Failure) {
    let (Failure::Usage(message) | Failure::Work(message)) = failure;
    // If stderr is closed there is no one left to tell.
    let _ = writeln!(std::io::stderr(), "nusselt: {message}");
}

/// Help and version are no failure; everything else is said in one line.
pub(crate) fn of_clap(error: &clap::Error) -> Result<(), Failure> {
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        return crate::output::print(&error.to_string());
    }
    if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return Err(Failure::Usage("say which subcommand to run (--help lists them)".to_owned()));
    }
    let text = error.to_string();
    // The first paragraph says what is wrong, sometimes on several lines; usage and tips follow.
    let words: Vec<&str> = text.lines().take_while(|line| !line.trim().is_empty()).map(str::trim).collect();
    let message = words.join(" ");
    let message = message.strip_prefix("error: ").unwrap_or(&message);
    let tip = text.lines().map(str::trim).find_map(|line| line.strip_prefix("tip: "));
    let tip = tip.map_or_else(String::new, |tip| format!("; {tip}"));
    Err(Failure::Usage(format!("{message}{tip} (--help explains)")))
}
