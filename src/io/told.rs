//! What a JSON parser says, for messages.

/// So many characters of a message are shown; it may quote names of any length from the file.
const SHOWN: usize = 240;

/// What is wrong, on one line.
pub(super) fn told(error: &serde_json::Error) -> String {
    let message = error.to_string().replacen("EOF while parsing", "the file ends in the midst of", 1);
    let nested = "lists and objects are nested too deep, more than 127 levels; flatten them";
    shortened(&message.replacen("recursion limit exceeded", nested, 1))
}

/// A message on one line, without what could control a terminal.
pub(super) fn shortened(message: &str) -> String {
    let clean = message.chars().map(|c| if c.is_control() { '?' } else { c });
    if message.chars().count() <= SHOWN {
        return clean.collect();
    }
    // Its end says where.
    let place = message.rfind(" at line ").filter(|&place| message.len() - place < 60).unwrap_or(message.len());
    clean.take(SHOWN).chain("...".chars()).chain(message[place..].chars()).collect()
}
