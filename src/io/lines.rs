//! The lines of text files, and the logical lines of OBJ and MTL files.

use std::borrow::Cow;

/// A line without comment and surrounding blanks, with the number (from 1) of the line it starts in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Line<'a> {
    pub(super) number: usize,
    pub(super) text: Cow<'a, str>,
}

impl Line<'_> {
    /// The keyword and the rest of the line.
    pub(super) fn split(&self) -> (&str, &str) {
        match self.text.split_once(is_blank) {
            Some((keyword, rest)) => (keyword, rest.trim_matches(is_blank)),
            None => (&self.text, ""),
        }
    }
}

pub(super) fn is_blank(c: char) -> bool {
    c.is_ascii_whitespace() || c == '\x0b' || c == '\0'
}

/// The logical lines that are not empty. Lines end with LF, CR LF or CR; one that ends with a backslash
/// goes on in the next. A `#` starts a comment at the start of a line or after a blank, so that
/// names may contain it. Bytes that are not UTF-8 are read as U+FFFD.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = Line<'_>> {
    lines_after(without_mark(bytes), 0)
}

/// The mark that a file of text may start with.
pub(super) const MARK: &[u8] = b"\xef\xbb\xbf";

/// The bytes without the mark that a file of text may start with.
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(MARK).unwrap_or(bytes)
}

/// The same of bytes that so many lines of the file come before.
pub(super) fn lines_after(bytes: &[u8], before: usize) -> impl Iterator<Item = Line<'_>> {
    let mut rest = bytes;
    let mut count = before;
    std::iter::from_fn(move || {
        while !rest.is_empty() {
            let number = count + 1;
            let (mut text, mut goes_on) = next_line(&mut rest, &mut count);
            while goes_on && !rest.is_empty() {
                let (more, again) = next_line(&mut rest, &mut count);
                let text = text.to_mut();
                text.push(' ');
                text.push_str(&more);
                goes_on = again;
            }
            let trimmed = match text {
                Cow::Borrowed(text) => Cow::Borrowed(text.trim_matches(is_blank)),
                Cow::Owned(text) => Cow::Owned(text.trim_matches(is_blank).to_owned()),
            };
            if !trimmed.is_empty() {
                return Some(Line { number, text: trimmed });
            }
        }
        None
    })
}

/// Takes a line off the rest. It ends with LF, CR LF or CR.
pub(super) fn take_line<'a>(rest: &mut &'a [u8]) -> &'a [u8] {
    let end = rest.iter().position(|&byte| byte == b'\n' || byte == b'\r').unwrap_or(rest.len());
    let (line, after) = rest.split_at(end);
    *rest = match after {
        [b'\r', b'\n', after @ ..] | [_, after @ ..] => after,
        [] => &[],
    };
    line
}

/// Takes a line off the rest; true if a backslash says that it goes on.
fn next_line<'a>(rest: &mut &'a [u8], count: &mut usize) -> (Cow<'a, str>, bool) {
    let line = take_line(rest);
    *count += 1;
    let is_comment = |k: usize| line[k] == b'#' && (k == 0 || is_blank(line[k - 1].into()));
    if let Some(start) = (0..line.len()).find(|&k| is_comment(k)) {
        return (String::from_utf8_lossy(&line[..start]), false);
    }
    match line.strip_suffix(b"\\") {
        Some(line) => (String::from_utf8_lossy(line), true),
        None => (String::from_utf8_lossy(line), false),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Vec<(usize, String)> {
        lines(bytes).map(|line| (line.number, line.text.into_owned())).collect()
    }

    #[test]
    fn lines_end_in_three_ways_and_go_on_after_a_backslash() {
        let text = b"\xef\xbb\xbfa 1\r\n\r\n b\t2 \\\n 3\\\r\n4\rc#d # e \\\n# f\\\ng\\";
        let expected = [(1, "a 1"), (3, "b\t2   3 4"), (6, "c#d"), (8, "g")];
        assert_eq!(read(text), expected.map(|(number, text)| (number, text.to_owned())));
    }

    #[test]
    fn any_bytes_are_lines() {
        assert_eq!(read(b""), []);
        assert_eq!(read(b"\\"), []);
        assert_eq!(read(b"\n\r\\\n\\\r\n"), []);
        assert_eq!(read(b"o \xff"), [(1, "o \u{fffd}".to_owned())]);
    }
}
