//! A text in blocks of whole lines, as it is read: of any length, in bounded memory.

use super::super::lines::{MARK, without_mark};
use std::io::{self, Read};

/// No line may be longer. Blocks are as large, or up to twice that.
const LONGEST: usize = 1 << 20;

/// So much is read at once of what is live: what a pipe holds.
const AT_ONCE: usize = 1 << 16;

/// Of a longer line so much is passed over to find its end; the text ends there if it has none. Standard input may never end.
const MOST_PASSED: usize = 1 << 28;

/// Reads blocks of whole lines, each line with those that it goes on in after a backslash.
pub(super) struct Blocks<R> {
    reader: R,
    buffer: Vec<u8>,
    /// So many bytes of the buffer were given out.
    given: usize,
    /// Lines before those in the buffer.
    lines: usize,
    is_at_start: bool,
    is_at_end: bool,
    /// Whether lines are given out as soon as they are there.
    is_live: bool,
    /// Before that place of the buffer no line ends.
    searched: usize,
}

/// Some of the text.
pub(super) enum Block<'a> {
    /// Whole lines, and how many lines come before them.
    Lines(&'a [u8], usize),
    /// The line of that number is longer than [`LONGEST`], and was passed over.
    TooLong(usize),
}

impl<R: Read> Blocks<R> {
    pub(super) fn new(reader: R) -> Self {
        Self {
            reader,
            buffer: Vec::new(),
            given: 0,
            lines: 0,
            is_at_start: true,
            is_at_end: false,
            is_live: false,
            searched: 0,
        }
    }

    /// Blocks hold what came with one read.
    pub(super) fn live(reader: R) -> Self {
        Self { is_live: true, ..Self::new(reader) }
    }

    pub(super) fn into_inner(self) -> R {
        self.reader
    }

    /// The next block; `None` at the end.
    pub(super) fn next(&mut self) -> io::Result<Option<Block<'_>>> {
        self.lines += ends(&self.buffer, self.given);
        self.buffer.drain(..self.given);
        (self.given, self.searched) = (0, 0);
        loop {
            self.fill(LONGEST)?;
            let may_be_mark = self.buffer.len() < MARK.len() && MARK.starts_with(&self.buffer);
            if self.is_at_start && may_be_mark && !self.is_at_end {
                continue;
            }
            if std::mem::take(&mut self.is_at_start) {
                let mark = self.buffer.len() - without_mark(&self.buffer).len();
                self.buffer.drain(..mark);
            }
            if self.buffer.is_empty() && self.is_at_end {
                return Ok(None);
            }
            if self.is_at_end {
                self.given = self.buffer.len();
            } else if let Some(end) = last_end(&self.buffer, self.searched) {
                self.given = end;
            } else if self.buffer.len() > LONGEST {
                return self.pass_over().map(Some);
            } else {
                self.searched = self.buffer.len();
                continue;
            }
            return Ok(Some(Block::Lines(&self.buffer[..self.given], self.lines)));
        }
    }

    /// Reads until there are more than so many bytes, or no more; if it is live, what there is.
    fn fill(&mut self, most: usize) -> io::Result<()> {
        if self.is_live {
            return self.read_once(most);
        }
        if self.buffer.len() <= most && !self.is_at_end {
            let wanted = (most + 1 - self.buffer.len()) as u64;
            let read = self.reader.by_ref().take(wanted).read_to_end(&mut self.buffer)?;
            self.is_at_end = (read as u64) < wanted;
        }
        Ok(())
    }

    fn read_once(&mut self, most: usize) -> io::Result<()> {
        let length = self.buffer.len();
        if length > most || self.is_at_end {
            return Ok(());
        }
        self.buffer.resize((length + AT_ONCE).min(most + 1), 0);
        let read = loop {
            match self.reader.read(&mut self.buffer[length..]) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                read => break read,
            }
        };
        self.buffer.truncate(length + *read.as_ref().unwrap_or(&0));
        self.is_at_end = read? == 0;
        Ok(())
    }

    /// Passes over a line that does not end within the buffer.
    fn pass_over(&mut self) -> io::Result<Block<'static>> {
        let number = self.lines + 1;
        let mut left = MOST_PASSED;
        loop {
            if let Some(end) = last_end(&self.buffer, 0) {
                // Of what follows the line, the last block may hold more lines: only the first is passed over.
                let first = first_end(&self.buffer).unwrap_or(end);
                self.lines += ends(&self.buffer, first);
                self.buffer.drain(..first);
                return Ok(Block::TooLong(number));
            }
            // The last bytes may be half of a line's end, or say that the line goes on.
            let kept = self.buffer.len().min(3);
            let passed = self.buffer.len() - kept;
            self.lines += ends(&self.buffer, passed);
            self.buffer.drain(..passed);
            left = left.saturating_sub(passed);
            self.fill(LONGEST)?;
            self.is_at_end |= left == 0;
            if self.is_at_end && last_end(&self.buffer, 0).is_none() {
                self.buffer.clear();
                return Ok(Block::TooLong(number));
            }
        }
    }
}

/// Where the last line ends that does not go on, if the buffer tells; not before that place.
fn last_end(buffer: &[u8], from: usize) -> Option<usize> {
    (from.max(1)..=buffer.len()).rev().find(|&end| is_end(buffer, end))
}

fn first_end(buffer: &[u8]) -> Option<usize> {
    (1..=buffer.len()).find(|&end| is_end(buffer, end))
}

/// True if a line ends before that place and certainly does not go on: after LF, or after CR if no LF follows, and if no backslash is before.
fn is_end(buffer: &[u8], end: usize) -> bool {
    let line = match buffer[..end] {
        [ref line @ .., b'\r', b'\n'] | [ref line @ .., b'\n'] => line,
        [ref line @ .., b'\r'] if buffer.get(end).is_some_and(|&next| next != b'\n') => line,
        _ => return false,
    };
    line.last() != Some(&b'\\')
}

/// How many lines end before that place.
fn ends(buffer: &[u8], place: usize) -> usize {
    let is_end = |&k: &usize| match buffer[k] {
        b'\n' => true,
        b'\r' => buffer.get(k + 1) != Some(&b'\n'),
        _ => false,
    };
    (0..place).filter(is_end).count()
}

#[cfg(test)]
mod tests {
    use super::super::super::lines::{Line, lines, lines_after};
    use super::*;
    use proptest::prelude::*;

    /// Gives a few bytes at a time.
    struct Slowly<'a>(&'a [u8], usize);

    impl Read for Slowly<'_> {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            let count = self.1.min(into.len()).min(self.0.len());
            into[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    fn in_blocks(bytes: &[u8], step: usize) -> Vec<Result<(usize, String), usize>> {
        let all = all_of(Blocks::new(Slowly(bytes, step)));
        assert_eq!(all_of(Blocks::live(Slowly(bytes, step))), all);
        all
    }

    fn all_of(mut blocks: Blocks<Slowly<'_>>) -> Vec<Result<(usize, String), usize>> {
        let mut all = Vec::new();
        while let Some(block) = blocks.next().expect("memory can be read") {
            match block {
                Block::Lines(bytes, before) => {
                    all.extend(lines_after(bytes, before).map(|line| Ok((line.number, line.text.into_owned()))));
                }
                Block::TooLong(number) => all.push(Err(number)),
            }
        }
        all
    }

    fn at_once(bytes: &[u8]) -> Vec<Result<(usize, String), usize>> {
        lines(bytes).map(|Line { number, text }| Ok((number, text.into_owned()))).collect()
    }

    #[test]
    fn long_lines_are_passed_over_and_counted() {
        let mut text = b"\xef\xbb\xbf1\n2\r\n".to_vec();
        text.extend(vec![b'x'; 3 * LONGEST]);
        text.extend(b"\\\r\ny\n5\n");
        text.extend(vec![b' '; LONGEST / 2]);
        text.extend(b"6\n");
        text.extend(vec![b'z'; LONGEST + 1]);
        let expected = [
            Ok((1, "1".to_owned())),
            Ok((2, "2".to_owned())),
            Err(3),
            Ok((5, "5".to_owned())),
            Ok((6, "6".to_owned())),
            Err(7),
        ];
        for step in [usize::MAX, 65_536, 4_099] {
            assert_eq!(in_blocks(&text, step), expected, "{step}");
        }
    }

    #[test]
    fn a_line_without_an_end_is_given_up() {
        let mut blocks = Blocks::new(io::repeat(b' '));
        assert!(matches!(blocks.next(), Ok(Some(Block::TooLong(1)))));
        assert!(matches!(blocks.next(), Ok(None)));
    }

    #[test]
    fn a_mark_that_comes_alone_is_no_end() {
        assert_eq!(in_blocks(b"\xef\xbb\xbfa", 3), [Ok((1, "a".to_owned()))]);
    }

    #[test]
    fn many_blocks_hold_the_same_lines() {
        let mut text = Vec::new();
        for k in 0..400_000 {
            text.extend(format!("{k} line").bytes());
            text.extend([&b"\n"[..], b"\r\n", b"\r", b"\\\n", b"# \\\r\n", b"\n\xef\xbb\xbf"][k % 6]);
        }
        assert!(text.len() > 4 * LONGEST);
        assert_eq!(in_blocks(&text, usize::MAX), at_once(&text));
    }

    proptest! {
        #[test]
        fn live_lines_are_the_same(text in "(\u{feff}|\u{fefe}|)[a\\\\# \r\n]{0,30}", step in 1_usize..6) {
            let bytes = text.as_bytes();
            prop_assert_eq!(in_blocks(bytes, step), at_once(bytes));
        }

        #[test]
        fn a_line_ends_where_it_ends_in_the_whole(text in "[a\\\\# \r\n]{0,30}") {
            // Wherever a block may end, the lines are the same.
            let bytes = text.as_bytes();
            for end in (1..=bytes.len()).filter(|&end| is_end(bytes, end)) {
                let (first, rest) = bytes.split_at(end);
                let mut parts: Vec<_> = lines_after(first, 0).collect();
                parts.extend(lines_after(rest, ends(first, first.len())));
                prop_assert_eq!(parts, lines_after(bytes, 0).collect::<Vec<_>>(), "{}", end);
            }
        }
    }
}
