//! The header of a PLY file: which elements with which properties follow it, and how they are written.

use super::super::error::Place;
use super::super::lines::{is_blank, take_line};
use super::super::number::shown;
use std::collections::HashSet;
use std::str::FromStr;

/// How the body is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    /// How many bytes it takes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

impl FromStr for Type {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(match text {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return Err(format!("{} is no type; it takes one like `float`, `uchar` or `int32`", shown(text))),
        })
    }
}

/// What an element has: a number, or a list of them with its length before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Number(Type),
    List { length: Type, item: Type },
}

#[derive(Clone, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
    /// Where the header has it.
    pub(super) line: usize,
}

impl Element {
    /// The fewest bytes that one takes in a binary file.
    pub(super) fn least_size(&self) -> usize {
        let size = |property: &Property| match property.kind {
            Kind::Number(number) => number.size(),
            Kind::List { length, .. } => length.size(),
        };
        self.properties.iter().map(size).sum()
    }
}

/// A header, and what follows it.
#[derive(Debug)]
pub(super) struct Header<'a> {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    pub(super) body: &'a [u8],
    /// The number of lines of the header.
    pub(super) lines: usize,
}

/// Reads the header; otherwise says where it is wrong, and how.
pub(super) fn parse(bytes: &[u8]) -> Result<Header<'_>, (Place, String)> {
    let mut rest = bytes;
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut names = HashSet::new();
    let mut lines = 0;
    while !rest.is_empty() {
        lines += 1;
        let text = String::from_utf8_lossy(take_line(&mut rest));
        let words: Vec<&str> = text.split(is_blank).filter(|word| !word.is_empty()).take(6).collect();
        if lines == 1 {
            if words != ["ply"] {
                return Err((Place::Line(1), "a PLY file starts with the line `ply`".to_owned()));
            }
            continue;
        }
        if words == ["end_header"] {
            let Some(encoding) = encoding else {
                return Err((Place::Line(lines), "the header has no line `format`".to_owned()));
            };
            return Ok(Header { encoding, elements, body: rest, lines });
        }
        read_line(&words, lines, &mut encoding, &mut elements, &mut names)
            .map_err(|what| (Place::Line(lines), what))?;
    }
    Err((Place::File, "its header has no `end_header`; it may be cut off".to_owned()))
}

fn read_line(
    words: &[&str],
    line: usize,
    encoding: &mut Option<Encoding>,
    elements: &mut Vec<Element>,
    names: &mut HashSet<String>,
) -> Result<(), String> {
    match words {
        [] | ["comment" | "obj_info", ..] => {}
        ["format", name, "1.0"] => {
            *encoding = Some(match *name {
                "ascii" => Encoding::Text,
                "binary_little_endian" => Encoding::LittleEndian,
                "binary_big_endian" => Encoding::BigEndian,
                _ => return Err(format!("the format {} is not known", shown(name))),
            });
        }
        ["element", name, count] => {
            let Ok(count) = count.parse() else {
                return Err(format!("{} is no number of elements", shown(count)));
            };
            if !names.insert((*name).to_owned()) {
                return Err(format!("there are two elements {}", shown(name)));
            }
            elements.push(Element { name: (*name).to_owned(), count, properties: Vec::new(), line });
        }
        ["property", "list", length, item, name] => {
            let kind = Kind::List { length: length.parse()?, item: item.parse()? };
            add(elements, name, kind)?;
        }
        ["property", number, name] => add(elements, name, Kind::Number(number.parse()?))?,
        _ => {
            return Err(format!(
                "the line {} is none of a header; it takes `format`, `element`, `property`, `comment` or `end_header`",
                shown(&words.join(" "))
            ));
        }
    }
    Ok(())
}

fn add(elements: &mut [Element], name: &str, kind: Kind) -> Result<(), String> {
    let Some(element) = elements.last_mut() else {
        return Err("a property before the first `element`".to_owned());
    };
    element.properties.push(Property { name: name.to_owned(), kind });
    Ok(())
}
