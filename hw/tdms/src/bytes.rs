//! Reading numbers and texts from bytes, in either byte order, never beyond the end.

/// Order of the bytes of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    Little,
    Big,
}

/// Defines a number from its bytes at a place; `None` if they are not all there.
macro_rules! numbers {
    ($($name:ident $number:ty),*) => {
        impl Order {
            $(pub fn $name(self, bytes: &[u8], at: usize) -> Option<$number> {
                const SIZE: usize = size_of::<$number>();
                let bytes: [u8; SIZE] = bytes.get(at..at.checked_add(SIZE)?)?.try_into().ok()?;
                Some(match self {
                    Order::Little => <$number>::from_le_bytes(bytes),
                    Order::Big => <$number>::from_be_bytes(bytes),
                })
            })*
        }
    };
}
numbers!(u8 u8, u16 u16, u32 u32, u64 u64, i8 i8, i16 i16, i32 i32, i64 i64, f32 f32, f64 f64);

/// A place in the bytes that moves on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    order: Order,
}

/// If the bytes end too early.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End(pub usize);

impl<'a> Cursor<'a> {
    /// From a place on, up to the end of the bytes.
    pub fn new(bytes: &'a [u8], at: usize, order: Order) -> Self {
        Self { bytes, at, order }
    }

    pub fn at(&self) -> usize {
        self.at
    }

    pub fn order(&self) -> Order {
        self.order
    }

    pub fn left(&self) -> usize {
        self.bytes.len().saturating_sub(self.at)
    }

    pub fn u8(&mut self) -> Result<u8, End> {
        let found = self.order.u8(self.bytes, self.at);
        self.advance(found, 1)
    }

    pub fn u32(&mut self) -> Result<u32, End> {
        let found = self.order.u32(self.bytes, self.at);
        self.advance(found, 4)
    }

    pub fn u64(&mut self) -> Result<u64, End> {
        let found = self.order.u64(self.bytes, self.at);
        self.advance(found, 8)
    }

    pub fn take(&mut self, count: usize) -> Result<&'a [u8], End> {
        let found = self.at.checked_add(count).and_then(|end| self.bytes.get(self.at..end));
        self.advance(found, count)
    }

    /// A text after its length; what is not UTF-8 is replaced.
    pub fn text(&mut self) -> Result<String, End> {
        let length = self.u32()? as usize;
        Ok(String::from_utf8_lossy(self.take(length)?).into_owned())
    }

    fn advance<T>(&mut self, found: Option<T>, count: usize) -> Result<T, End> {
        let found = found.ok_or(End(self.at))?;
        self.at += count;
        Ok(found)
    }
}
