//! The numbers of a PLY body, one by one, however they are written.

use super::super::lines::{is_blank, take_line};
use super::super::number;
use super::header::{Encoding, Type};

/// What is left of a body.
pub(super) struct Source<'a> {
    encoding: Encoding,
    rest: &'a [u8],
    /// The number of the line that was begun last, from 1.
    pub(super) line: usize,
    /// What is left of that line.
    text: String,
    at: usize,
}

/// Why there is no number.
pub(super) enum Missing {
    /// The file ends before it.
    End,
    /// It is no number, or the line ends before it. The next line can be read all the same.
    Bad(String),
}

/// What there is after the last element.
pub(super) enum LeftOver {
    Nothing,
    /// Text, from this line on.
    Line(usize),
    Bytes(usize),
}

impl<'a> Source<'a> {
    /// The body that follows a header of so many lines.
    pub(super) fn new(encoding: Encoding, body: &'a [u8], lines: usize) -> Self {
        Self { encoding, rest: body, line: lines, text: String::new(), at: 0 }
    }

    pub(super) fn is_text(&self) -> bool {
        self.encoding == Encoding::Text
    }

    /// How many bytes there are at most for what is still to come.
    pub(super) fn bytes_left(&self) -> usize {
        self.rest.len() + self.text.len() - self.at
    }

    /// Begins an element: in text files it has a line of its own, and empty lines are passed over.
    pub(super) fn begin(&mut self) -> Result<(), Missing> {
        if !self.is_text() {
            return Ok(());
        }
        while !self.rest.is_empty() {
            self.line += 1;
            let line = take_line(&mut self.rest);
            if line.iter().any(|&byte| !is_blank(byte.into())) {
                self.text.clear();
                self.text.push_str(&String::from_utf8_lossy(line));
                self.at = 0;
                return Ok(());
            }
        }
        Err(Missing::End)
    }

    /// True if there is more in the line of a text element than was read.
    pub(super) fn has_surplus(&self) -> bool {
        self.text[self.at..].contains(|c| !is_blank(c))
    }

    /// What is left when all was read, line ends apart.
    pub(super) fn left_over(&mut self) -> LeftOver {
        if self.is_text() {
            return if self.begin().is_ok() { LeftOver::Line(self.line) } else { LeftOver::Nothing };
        }
        match self.rest.len() {
            _ if self.rest.trim_ascii().is_empty() => LeftOver::Nothing,
            count => LeftOver::Bytes(count),
        }
    }

    fn word(&mut self) -> Result<&str, Missing> {
        let rest = &self.text[self.at..];
        let start = rest.find(|c| !is_blank(c)).ok_or_else(|| Missing::Bad("the line ends too early".to_owned()))?;
        let rest = &rest[start..];
        let length = rest.find(is_blank).unwrap_or(rest.len());
        self.at += start + length;
        Ok(&rest[..length])
    }

    fn take(&mut self, bytes: usize) -> Result<&'a [u8], Missing> {
        let (taken, rest) = self.rest.split_at_checked(bytes).ok_or(Missing::End)?;
        self.rest = rest;
        Ok(taken)
    }

    /// The next number. In binary files it may be anything, infinite or not a number too.
    pub(super) fn number(&mut self, kind: Type) -> Result<f64, Missing> {
        if self.is_text() {
            return number::parse(self.word()?).map_err(Missing::Bad);
        }
        let is_big = self.encoding == Encoding::BigEndian;
        let taken = self.take(kind.size())?;
        let mut bytes = [0; 8];
        for (k, &byte) in taken.iter().enumerate() {
            bytes[if is_big { taken.len() - 1 - k } else { k }] = byte;
        }
        let [a, b, c, d, ..] = bytes;
        Ok(match kind {
            Type::I8 => i8::from_le_bytes([a]).into(),
            Type::U8 => a.into(),
            Type::I16 => i16::from_le_bytes([a, b]).into(),
            Type::U16 => u16::from_le_bytes([a, b]).into(),
            Type::I32 => i32::from_le_bytes([a, b, c, d]).into(),
            Type::U32 => u32::from_le_bytes([a, b, c, d]).into(),
            Type::F32 => f32::from_le_bytes([a, b, c, d]).into(),
            Type::F64 => f64::from_le_bytes(bytes),
        })
    }

    /// Passes over so many numbers.
    pub(super) fn skip(&mut self, kind: Type, count: usize) -> Result<(), Missing> {
        if self.is_text() {
            return (0..count).try_for_each(|_| self.word().map(|_| ()));
        }
        self.take(count.checked_mul(kind.size()).ok_or(Missing::End)?).map(|_| ())
    }

    /// The length of a list.
    pub(super) fn length(&mut self, kind: Type) -> Result<usize, Missing> {
        let number = self.number(kind)?;
        let length = whole(number).ok_or_else(|| Missing::Bad(format!("{number} is no length of a list")))?;
        // Every item takes a byte at least.
        if length > self.bytes_left() { Err(Missing::End) } else { Ok(length) }
    }
}

/// The number as an index, if it is one.
#[expect(clippy::float_cmp, reason = "indices are whole numbers exactly")]
pub(super) fn whole(number: f64) -> Option<usize> {
    (0.0..=f64::from(u32::MAX)).contains(&number).then_some(number as usize).filter(|&index| index as f64 == number)
}
