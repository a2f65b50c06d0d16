//! Records of Linux IIO devices: analogue-to-digital converters as the kernel delivers them.

use crate::raw::Channels;

/// How a value lies in a record, as a `scan_elements/*_type` file says: `[be|le]:[s|u]bits/storagebits[Xrepeat][>>shift]`.
///
/// ```
/// use rod_hw::ScanType;
/// let found = ScanType::parse("be:s24/32>>8\n")?; // 24 of 32 bits, from the upper end
/// assert_eq!((found.bits, found.storage_bits, found.shift), (24, 32, 8));
/// assert_eq!(found.value(&[0xff, 0xff, 0xfe, 0x77]), Some(-2));
/// # Ok::<(), rod_hw::IioError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScanType {
    /// Whether the first byte is the upper one.
    pub is_big_endian: bool,
    /// Whether the value has a sign.
    pub is_signed: bool,
    /// Bits of the value.
    pub bits: u32,
    /// Bits of the place it lies in: 8, 16, 32 or 64.
    pub storage_bits: u32,
    /// How many values lie there side by side.
    pub repeat: u32,
    /// By how many bits the value lies above the lower end.
    pub shift: u32,
}

/// Why a record cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum IioError {
    /// A type that is none.
    #[error(
        "the type of a scan element has {what}, expected the form `[be|le]:[s|u]bits/storagebits[Xrepeat][>>shift]`, \
         `le:s24/32>>8` for instance"
    )]
    Type {
        /// What is wrong with it.
        what: &'static str,
    },
    /// Too many values for a sample.
    #[error("a record of {found} values, expected 1 to {most}; enable fewer channels")]
    Count {
        /// How many there are, a time not counted.
        found: usize,
        /// How many there can be.
        most: usize,
    },
}

impl ScanType {
    /// A time as the kernel adds it: ns.
    pub const TIMESTAMP: Self = Self {
        is_big_endian: cfg!(target_endian = "big"),
        is_signed: true,
        bits: 64,
        storage_bits: 64,
        repeat: 1,
        shift: 0,
    };

    /// From the contents of the file; a line break at the end does not matter.
    ///
    /// # Errors
    /// [`IioError::Type`].
    pub fn parse(text: &str) -> Result<Self, IioError> {
        let error = |what| IioError::Type { what };
        let (order, rest) = text.trim().split_once(':').ok_or(error("no colon"))?;
        let is_big_endian = match order {
            "be" => true,
            "le" => false,
            _ => return Err(error("an order of bytes other than `be` and `le`")),
        };
        let is_signed = match rest.as_bytes().first() {
            Some(b's') => true,
            Some(b'u') => false,
            _ => return Err(error("a sign other than `s` and `u`")),
        };
        let (bits, rest) = rest.get(1..).unwrap_or_default().split_once('/').ok_or(error("no slash"))?;
        let (rest, shift) = rest.split_once(">>").unwrap_or((rest, "0"));
        let (storage, repeat) = rest.split_once('X').unwrap_or((rest, "1"));
        let number = |text: &str| text.parse::<u32>().map_err(|_| error("a number that is none"));
        let (bits, storage_bits) = (number(bits)?, number(storage)?);
        let (repeat, shift) = (number(repeat)?, number(shift)?);
        if !matches!(storage_bits, 8 | 16 | 32 | 64) {
            return Err(error("a storage other than 8, 16, 32 or 64 bits"));
        }
        if bits == 0 || shift > 64 || bits > 64 || bits + shift > storage_bits {
            return Err(error("more bits than its storage, or none"));
        }
        // where an element lies that is 3 values wide, the kernel does not say
        if !matches!(repeat, 1 | 2 | 4 | 8 | 16) {
            return Err(error("a repeat other than 1, 2, 4, 8 or 16"));
        }
        Ok(Self { is_big_endian, is_signed, bits, storage_bits, repeat, shift })
    }

    /// Bytes of one value.
    pub fn size(&self) -> usize {
        self.storage_bits as usize / 8
    }

    /// The value in so many bytes; none where they are too few. Unsigned values of 64 bits beyond 2^63 wrap.
    pub fn value(&self, bytes: &[u8]) -> Option<i64> {
        let bytes = bytes.get(..self.size())?;
        let join = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
        let stored = if self.is_big_endian { bytes.iter().fold(0, join) } else { bytes.iter().rev().fold(0, join) };
        // the value to the upper end, and back with its sign or without
        let left = 64_u32.checked_sub(self.bits.checked_add(self.shift)?)?;
        let right = 64_u32.checked_sub(self.bits)?;
        let upper = stored.checked_shl(left)?;
        Some(if self.is_signed { (upper as i64).checked_shr(right)? } else { upper.checked_shr(right)? as i64 })
    }
}

/// Values of a record of enabled scan elements: each lies at a multiple of its size, a time, if any, at the end.
///
/// ```
/// use rod_hw::{IioRecord, ScanType};
/// let count = ScanType::parse("le:s16/16")?;
/// // three counts in the order of their `*_index`, then a time, from byte 8 on
/// let record = IioRecord::new(&[count, count, count], true)?;
/// assert_eq!(record.size(), 16);
/// let bytes = [1, 0, 0xfe, 0xff, 3, 0, 0, 0, 0x40, 0x42, 0x0f, 0, 0, 0, 0, 0];
/// let (values, time) = record.read(&bytes).ok_or("too short")?;
/// assert_eq!(values[..], [1.0, -2.0, 3.0]); // counts; offset and scale of the device are of its calibration
/// assert_eq!(time, Some(1_000_000)); // ns
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct IioRecord {
    /// Where each value lies.
    places: [(usize, ScanType); Channels::MOST],
    count: usize,
    time: Option<usize>,
    size: usize,
}

impl IioRecord {
    /// Of the elements that are enabled (`*_en`), in the order of their `*_index`, and whether `in_timestamp` is.
    ///
    /// # Errors
    /// [`IioError::Count`].
    pub fn new(elements: &[ScanType], has_time: bool) -> Result<Self, IioError> {
        let found = elements.iter().map(|element| element.repeat as usize).sum();
        let error = IioError::Count { found, most: Channels::MOST };
        if found == 0 {
            return Err(error);
        }
        let mut places = [(0, ScanType::TIMESTAMP); Channels::MOST];
        let (mut count, mut at, mut widest) = (0, 0_usize, 1);
        for element in elements {
            // an element that repeats is as wide as all of its values
            let width = element.size().saturating_mul(element.repeat as usize);
            at = at.next_multiple_of(width.max(1));
            widest = widest.max(width);
            for _ in 0..element.repeat {
                *places.get_mut(count).ok_or(error)? = (at, *element);
                at += element.size();
                count += 1;
            }
        }
        let time = has_time.then(|| at.next_multiple_of(8));
        if let Some(start) = time {
            (at, widest) = (start + 8, widest.max(8));
        }
        Ok(Self { places, count, time, size: at.next_multiple_of(widest) })
    }

    /// Bytes of a record.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The values, as counts, and the time, ns by the clock that the device is set to; none where the bytes are too few.
    #[expect(clippy::cast_precision_loss, reason = "no converter has more than 53 bits")]
    pub fn read(&self, bytes: &[u8]) -> Option<(Channels, Option<i64>)> {
        let bytes = bytes.get(..self.size)?;
        let mut values = [0.0; Channels::MOST];
        for (value, (at, element)) in values.iter_mut().zip(self.places.get(..self.count)?) {
            *value = element.value(bytes.get(*at..)?)? as f64;
        }
        let time = match self.time {
            Some(at) => Some(ScanType::TIMESTAMP.value(bytes.get(at..)?)?),
            None => None,
        };
        Some((Channels::new(values.get(..self.count)?)?, time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn types() {
        let parse = |text| ScanType::parse(text).unwrap();
        assert_eq!(parse("le:s64/64>>0"), ScanType { is_big_endian: false, ..ScanType::TIMESTAMP });
        let found = parse("le:u12/16X4>>4");
        assert_eq!((found.is_signed, found.bits, found.repeat, found.shift), (false, 12, 4, 4));
        // 0xfff above four bits of something else
        assert_eq!(found.value(&[0xf7, 0xff]), Some(4095));
        assert_eq!(parse("le:s12/16>>4").value(&[0xf7, 0xff]), Some(-1));
        assert_eq!(parse("be:u24/32").value(&[0xaa, 0x80, 0, 1]), Some(0x80_0001));
        assert_eq!(parse("le:s8/8").value(&[0x80]), Some(-128));
        assert_eq!(parse("le:s16/16").value(&[1]), None);
        for text in [
            "",
            "le",
            "xe:s8/8",
            "le:f8/8",
            "le:s8",
            "le:s/8",
            "le:s0/8",
            "le:s9/8",
            "le:s8/12",
            "le:s8/8>>1",
            "le:s8/8X0",
            "le:s8/8X3",
        ] {
            assert!(ScanType::parse(text).is_err(), "{text}");
        }
        let error = ScanType::parse("le:s9/8").unwrap_err().to_string();
        assert!(
            error.starts_with("the type of a scan element has more bits than its storage, or none, expected"),
            "{error}"
        );
    }

    #[test]
    fn places() {
        let of = |texts: &[&str], has_time| {
            let elements: Vec<_> = texts.iter().map(|text| ScanType::parse(text).unwrap()).collect();
            let record = IioRecord::new(&elements, has_time)?;
            let places: Vec<_> = record.places[..record.count].iter().map(|place| place.0).collect();
            Ok::<_, IioError>((places, record.time, record.size))
        };
        // as the kernel's documentation has it: each at a multiple of its size, the time at one of eight
        assert_eq!(of(&["le:s8/8", "le:s16/16", "le:s8/8", "le:s32/32"], true), Ok((vec![0, 2, 4, 8], Some(16), 24)));
        assert_eq!(of(&["le:s16/16"; 3], false), Ok((vec![0, 2, 4], None, 6)));
        assert_eq!(of(&["le:s32/32", "le:s8/8"], false), Ok((vec![0, 4], None, 8)));
        assert_eq!(of(&["le:s8/8", "le:s16/16X4"], false), Ok((vec![0, 8, 10, 12, 14], None, 16)));
        assert_eq!(of(&[], true), Err(IioError::Count { found: 0, most: 16 }));
        assert_eq!(of(&["le:s8/8"; 17], false), Err(IioError::Count { found: 17, most: 16 }));
    }

    proptest! {
        #[test]
        fn any_text_and_bytes(text in "(be|le):[su][0-9]{1,3}/(8|16|32|64)(X[0-9])?(>>[0-9]{1,2})?|.{0,20}", bytes in prop::collection::vec(any::<u8>(), 0..40)) {
            if let Ok(found) = ScanType::parse(&text) {
                found.value(&bytes);
                if let Ok(record) = IioRecord::new(&[found; 2], true) {
                    prop_assert_eq!(record.read(&bytes).is_some(), bytes.len() >= record.size());
                }
            }
        }
    }
}
