//! What ends the program, and how it is said.

use clap::error::ErrorKind;
use std::fmt::Display;
use std::io::Write;
use std::path::Path;

/// Why the program did not do what it was asked for.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The command line is wrong: exit code 2.
    Usage(String),
    /// The input or the work failed: exit code 1.
    Work(String),
}

impl Failure {
    /// The work on a file failed.
    pub(crate) fn about(file: &Path, error: &impl Display) -> Self {
        Self::Work(format!("{}: {error}", file.display()))
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use nusselt::bsp::BspError;
    use nusselt::contour::ViewError;

    #[test]
    fn limits_are_failures_of_the_work_that_name_the_scene() {
        let file = Path::new("rooms/a.obj");
        let failures = [
            Failure::about(file, &BspError::TooManyFragments { limit: 7 }),
            Failure::about(file, &ViewError::TooManyCells { limit: 7 }),
        ];
        for failure in failures {
            let Failure::Work(message) = failure else { panic!("not exit code 1: {failure:?}") };
            assert!(message.starts_with("rooms/a.obj: ") && message.contains("more than 7"), "{message}");
        }
    }
}
