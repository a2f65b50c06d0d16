//! A writer of TDMS files for tests, which shares nothing with the reader.

/// Bytes of numbers in one of the two orders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Endian {
    Little,
    Big,
}

impl Endian {
    /// The last `size` bytes of the number, in this order.
    pub fn bytes(self, number: u128, size: usize) -> Vec<u8> {
        let big = &number.to_be_bytes()[16 - size..];
        match self {
            Self::Big => big.to_vec(),
            Self::Little => big.iter().rev().copied().collect(),
        }
    }

    pub fn f64s(self, numbers: &[f64]) -> Vec<u8> {
        numbers.iter().flat_map(|number| self.bytes(number.to_bits().into(), 8)).collect()
    }

    pub fn i16s(self, numbers: &[i16]) -> Vec<u8> {
        numbers.iter().flat_map(|number| self.bytes((*number as u16).into(), 2)).collect()
    }

    pub fn text(self, text: &str) -> Vec<u8> {
        [self.bytes(text.len() as u128, 4), text.as_bytes().to_vec()].concat()
    }
}

pub const F64: u32 = 10;
pub const I16: u32 = 2;
pub const TEXT: u32 = 0x20;

pub const INTERLEAVED: u32 = 1 << 5;
pub const KEEP_LIST: u32 = 1 << 30; // not of the format: takes the bit of the new list away
pub const NO_METADATA: u32 = 1 << 31; // likewise that of the metadata
pub const DAQMX: u32 = 1 << 7;

/// The raw data index of an object.
#[derive(Clone)]
pub enum Index {
    None,
    Same,
    /// Type, count.
    Values(u32, u64),
    /// Count, bytes.
    Texts(u64, u64),
    /// Digital lines or not; count; type, buffer, byte or bit, number of each scaler; widths.
    Daqmx(bool, u64, Vec<[u32; 4]>, Vec<u32>),
}

/// An object of a segment.
#[derive(Clone)]
pub struct Object {
    pub path: &'static str,
    pub index: Index,
    /// Names, codes of types and bytes of properties.
    pub properties: Vec<(String, u32, Vec<u8>)>,
}

impl Object {
    pub fn new(path: &'static str, index: Index) -> Self {
        Self { path, index, properties: Vec::new() }
    }

    pub fn with(mut self, endian: Endian, name: &str, value: f64) -> Self {
        self.properties.push((name.to_owned(), F64, endian.f64s(&[value])));
        self
    }

    pub fn with_count(mut self, endian: Endian, name: &str, value: u32) -> Self {
        self.properties.push((name.to_owned(), 7, endian.bytes(value.into(), 4)));
        self
    }

    pub fn with_text(mut self, endian: Endian, name: &str, value: &str) -> Self {
        self.properties.push((name.to_owned(), TEXT, endian.text(value)));
        self
    }
}

/// A segment of objects and raw data; `flags` beside what follows from these.
pub fn segment(endian: Endian, flags: u32, objects: &[Object], raw: &[u8]) -> Vec<u8> {
    let number = |value: u64, size| endian.bytes(value.into(), size);
    let mut metadata = number(objects.len() as u64, 4);
    for Object { path, index, properties } in objects {
        metadata.extend(endian.text(path));
        match index {
            Index::None => metadata.extend([0xff; 4]),
            Index::Same => metadata.extend([0; 4]),
            Index::Values(code, count) => {
                metadata.extend([number(20, 4), number((*code).into(), 4), number(1, 4), number(*count, 8)].concat());
            }
            Index::Texts(count, bytes) => {
                metadata.extend([number(28, 4), number(TEXT.into(), 4), number(1, 4)].concat());
                metadata.extend([number(*count, 8), number(*bytes, 8)].concat());
            }
            Index::Daqmx(digital, count, scalers, widths) => {
                let header = if *digital { 0x126a } else { 0x1269 };
                metadata.extend([number(header, 4), number(0xffff_ffff, 4), number(1, 4), number(*count, 8)].concat());
                metadata.extend(number(scalers.len() as u64, 4));
                for &[code, buffer, place, id] in scalers {
                    metadata.extend([code, buffer, place].iter().flat_map(|&value| number(value.into(), 4)));
                    metadata.extend(number(0, if *digital { 1 } else { 4 }));
                    metadata.extend(number(id.into(), 4));
                }
                metadata.extend(number(widths.len() as u64, 4));
                metadata.extend(widths.iter().flat_map(|&width| number(width.into(), 4)));
            }
        }
        metadata.extend(number(properties.len() as u64, 4));
        for (name, code, bytes) in properties {
            metadata.extend([endian.text(name), number((*code).into(), 4), bytes.clone()].concat());
        }
    }
    if flags & NO_METADATA != 0 {
        metadata.clear();
    }
    let mut contents = flags & !(KEEP_LIST | NO_METADATA);
    contents |= if flags & NO_METADATA == 0 { 1 << 1 } else { 0 };
    contents |= if flags & (KEEP_LIST | NO_METADATA) == 0 { 1 << 2 } else { 0 };
    contents |= if raw.is_empty() { 0 } else { 1 << 3 };
    contents |= if endian == Endian::Big { 1 << 6 } else { 0 };
    let mut bytes = b"TDSm".to_vec();
    bytes.extend(contents.to_le_bytes());
    bytes.extend(number(4713, 4));
    bytes.extend(number((metadata.len() + raw.len()) as u64, 8));
    bytes.extend(number(metadata.len() as u64, 8));
    bytes.extend(metadata);
    bytes.extend(raw);
    bytes
}
