//! Reading numbers and texts from bytes, in either byte order, never beyond the end.

/// Order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    Big,
}

/// A place in the bytes that moves on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    order: Order,
}

/// If the bytes end too early.
#[derive(Clone, Copy, Debug)]
pub(super) struct End(pub usize);

/// Defines the methods that read a number.
macro_rules! numbers {
    ($($number:ident)*) => {
        impl Cursor<'_> {
            $(pub fn $number(&mut self) -> Result<$number, End> {
                let found = self.bytes.get(self.at..).and_then(|rest| rest.first_chunk()).ok_or(End(self.at))?;
                self.at += found.len();
                Ok(match self.order {
                    Order::Little => $number::from_le_bytes(*found),
                    Order::Big => $number::from_be_bytes(*found),
                })
            })*
        }
    };
}
numbers!(u16 u32 u64 i32 f64);

impl<'a> Cursor<'a> {
    /// From a place on, up to the end of the bytes.
    pub fn new(bytes: &'a [u8], at: usize, order: Order) -> Self {
        Self { bytes, at, order }
    }

    pub fn at(&self) -> usize {
        self.at
    }

    pub fn left(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    /// On to the next multiple of `size` from the byte `base` on.
    pub fn align(&mut self, base: usize, size: usize) {
        self.at = base + self.at.saturating_sub(base).next_multiple_of(size);
    }

    pub fn take(&mut self, count: usize) -> Result<&'a [u8], End> {
        let found = self.bytes.get(self.at..).and_then(|rest| rest.get(..count)).ok_or(End(self.at))?;
        self.at += count;
        Ok(found)
    }

    /// A text after its length; what is not UTF-8 is replaced.
    pub fn text(&mut self) -> Result<String, End> {
        let length = self.u32()? as usize;
        Ok(String::from_utf8_lossy(self.take(length)?).into_owned())
    }
}
