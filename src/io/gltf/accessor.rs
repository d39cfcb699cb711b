//! The elements of accessors: numbers at regular distances in a buffer, some of them replaced.

use super::buffers::Buffers;
use super::json::{Accessor, Root, Sparse, View};
use glam::DVec3;

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(code: u32) -> Result<Self, String> {
        Ok(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return Err(format!("there is no component type {code}")),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// The k-th number of an element.
    fn number(self, element: &[u8], k: usize) -> f64 {
        let byte = |i: usize| element[k * self.size() + i];
        match self {
            Self::I8 => i8::from_le_bytes([byte(0)]).into(),
            Self::U8 => byte(0).into(),
            Self::I16 => i16::from_le_bytes([byte(0), byte(1)]).into(),
            Self::U16 => u16::from_le_bytes([byte(0), byte(1)]).into(),
            Self::U32 => u32::from_le_bytes([byte(0), byte(1), byte(2), byte(3)]).into(),
            Self::F32 => f32::from_le_bytes([byte(0), byte(1), byte(2), byte(3)]).into(),
        }
    }

    /// What a number stands for if it is normalised.
    fn normalised(self, number: f64) -> f64 {
        match self {
            Self::I8 => (number / 127.0).max(-1.0),
            Self::U8 => number / 255.0,
            Self::I16 => (number / 32_767.0).max(-1.0),
            Self::U16 => number / 65_535.0,
            Self::U32 | Self::F32 => number,
        }
    }

    fn is_index(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32)
    }
}

/// Elements at regular distances, all within the bytes.
#[derive(Debug)]
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
}

impl<'a> Strided<'a> {
    /// Checks that so many elements of a size fit into a view, from an offset on.
    fn new(
        (bytes, stride): (&'a [u8], Option<usize>),
        offset: usize,
        count: usize,
        size: usize,
    ) -> Result<Self, String> {
        let stride = stride.unwrap_or(size);
        if stride < size {
            return Err(format!("its elements of {size} bytes are only {stride} bytes apart"));
        }
        let length = match count {
            0 => Some(0),
            _ => stride.checked_mul(count - 1).and_then(|length| length.checked_add(size)),
        };
        let range = length.and_then(|length| bytes.get(offset..)?.get(..length));
        let Some(bytes) = range else {
            let there = bytes.len();
            return Err(format!(
                "its {count} elements from byte {offset} on do not fit into the {there} bytes of the view"
            ));
        };
        Ok(Self { bytes, stride, size })
    }

    fn get(&self, k: usize) -> &'a [u8] {
        &self.bytes[k * self.stride..][..self.size]
    }
}

/// Elements that replace others.
#[derive(Debug)]
struct Replaced<'a> {
    count: usize,
    indices: Strided<'a>,
    component: Component,
    values: Strided<'a>,
}

impl<'a> Replaced<'a> {
    fn index(&self, k: usize) -> usize {
        self.component.number(self.indices.get(k), 0) as usize
    }

    /// What replaces an element, if anything does.
    fn get(&self, element: usize) -> Option<&'a [u8]> {
        let (mut low, mut high) = (0, self.count);
        while low < high {
            let middle = low.midpoint(high);
            match self.index(middle).cmp(&element) {
                std::cmp::Ordering::Less => low = middle + 1,
                std::cmp::Ordering::Equal => return Some(self.values.get(middle)),
                std::cmp::Ordering::Greater => high = middle,
            }
        }
        None
    }
}

/// The elements of an accessor, all of them there.
#[derive(Debug)]
pub(super) struct Elements<'a> {
    pub(super) count: usize,
    component: Component,
    is_normalised: bool,
    /// How many numbers an element has.
    width: usize,
    /// Without it all numbers are 0.
    base: Option<Strided<'a>>,
    replaced: Option<Replaced<'a>>,
}

impl<'a> Elements<'a> {
    /// Checks an accessor whose buffers were loaded.
    pub(super) fn new(root: &Root, buffers: &'a Buffers<'_>, accessor: &Accessor) -> Result<Self, String> {
        let component = Component::of(accessor.component_type)?;
        let width = match accessor.r#type.as_str() {
            "SCALAR" => 1,
            "VEC3" => 3,
            _ => return Err("its type is neither SCALAR (for indices) nor VEC3 (for positions)".to_owned()),
        };
        let (count, size) = (accessor.count, width * component.size());
        let base = match accessor.buffer_view {
            Some(view) => Some(Strided::new(bytes_of(root, buffers, view)?, accessor.byte_offset, count, size)?),
            None => None,
        };
        let replaced = match &accessor.sparse {
            Some(sparse) => Some(replaced(root, buffers, sparse, count, size)?),
            None => None,
        };
        Ok(Self { count, component, is_normalised: accessor.normalized, width, base, replaced })
    }

    /// Whether these can be positions.
    pub(super) fn check_positions(&self) -> Result<(), String> {
        if self.width == 3 && self.component != Component::U32 {
            return Ok(());
        }
        Err("positions take an accessor of type VEC3, of floats or (quantised) of bytes or shorts".to_owned())
    }

    /// Whether these can be indices.
    pub(super) fn check_indices(&self) -> Result<(), String> {
        if self.width == 1 && self.component.is_index() && !self.is_normalised {
            return Ok(());
        }
        Err("indices take an accessor of type SCALAR, of unsigned bytes, shorts or ints".to_owned())
    }

    fn number(&self, k: usize, coordinate: usize) -> f64 {
        let replaced = self.replaced.as_ref().and_then(|replaced| replaced.get(k));
        let Some(element) = replaced.or_else(|| self.base.as_ref().map(|base| base.get(k))) else { return 0.0 };
        let number = self.component.number(element, coordinate);
        if self.is_normalised { self.component.normalised(number) } else { number }
    }

    /// The k-th position; the accessor must have one.
    pub(super) fn position(&self, k: usize) -> DVec3 {
        DVec3::from([0, 1, 2].map(|coordinate| self.number(k, coordinate)))
    }

    /// The k-th index; the accessor must have one.
    pub(super) fn index(&self, k: usize) -> usize {
        self.number(k, 0) as usize
    }
}

/// The buffers that an accessor takes.
pub(super) fn buffers_of(root: &Root, accessor: &Accessor) -> impl Iterator<Item = usize> {
    let sparse = accessor.sparse.iter().flat_map(|sparse| [sparse.indices.buffer_view, sparse.values.buffer_view]);
    accessor.buffer_view.into_iter().chain(sparse).filter_map(|view| Some(root.buffer_views.get(view)?.buffer))
}

/// The bytes of a view, and the distance of elements in it if it says so.
fn bytes_of<'a>(root: &Root, buffers: &'a Buffers<'_>, view: usize) -> Result<(&'a [u8], Option<usize>), String> {
    let Some(View { buffer, byte_offset, byte_length, byte_stride }) = root.buffer_views.get(view) else {
        return Err(format!("there is no buffer view {view}; the file has {}", root.buffer_views.len()));
    };
    let Some(bytes) = buffers.bytes(*buffer) else {
        return Err(format!("the bytes of buffer {buffer} are not there"));
    };
    match bytes.get(*byte_offset..).and_then(|rest| rest.get(..*byte_length)) {
        Some(bytes) => Ok((bytes, *byte_stride)),
        None => Err(format!("buffer view {view} ends after the {} bytes of buffer {buffer}", bytes.len())),
    }
}

fn replaced<'a>(
    root: &Root,
    buffers: &'a Buffers<'_>,
    sparse: &Sparse,
    count: usize,
    size: usize,
) -> Result<Replaced<'a>, String> {
    let Sparse { count: replacements, indices, values } = sparse;
    let component = Component::of(indices.component_type)?;
    if !component.is_index() {
        return Err("its sparse indices are not unsigned bytes, shorts or ints".to_owned());
    }
    let view = |view: usize| bytes_of(root, buffers, view);
    let (index_view, value_view) = (view(indices.buffer_view)?, view(values.buffer_view)?);
    let replaced = Replaced {
        count: *replacements,
        indices: Strided::new(index_view, indices.byte_offset, *replacements, component.size())?,
        component,
        values: Strided::new(value_view, values.byte_offset, *replacements, size)?,
    };
    let mut next = 0;
    for k in 0..*replacements {
        let index = replaced.index(k);
        if index < next || index >= count {
            return Err(format!("its sparse indices do not ascend below {count}: number {k} is {index}"));
        }
        next = index + 1;
    }
    Ok(replaced)
}
