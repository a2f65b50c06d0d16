//! The stream of a sensor, and what differs between devices.

use super::packets::{RdtRecord, RdtRequest};
use crate::link::{FrameFault, LinkCounters, Protocol, Request, Sequence};
use crate::sample::{Channels, Quality, RawSample};
use core::mem::take;

/// The family of a sensor: all have the same records, but different status words.
///
/// ```
/// use rod_hw::{Quality, device::rdt::RdtProfile};
/// let bit_30 = 0xC000_0000;
/// assert_eq!(RdtProfile::Axia.quality(bit_30), Quality::SATURATED);
/// assert_eq!(RdtProfile::NetFt.quality(bit_30), Quality::DEVICE_ERROR);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RdtProfile {
    /// ATI Net F/T (the box with a transducer at its cable).
    NetFt,
    /// ATI Ethernet Axia.
    Axia,
    /// OnRobot, before OptoForce, Ethernet converter.
    OnRobot,
}

/// Bits of one family: what they say.
struct Bits {
    /// Values beyond what the sensor can measure.
    saturated: u32,
    /// Values may be good.
    warning: u32,
    /// Values are wrong.
    error: u32,
    /// Something of the above; alone or with bits that are not known, an error.
    summary: u32,
}

impl RdtProfile {
    const fn bits(self) -> Bits {
        match self {
            // "transducer saturation or A/D error"; "monitor condition latched"; two bits are reserved
            Self::NetFt => Bits { saturated: 1 << 17, warning: 1 << 16, error: 0x7FFC_7FFE, summary: 1 << 31 },
            // force/torque and gauge out of range; latched; temperature, supply, broken gauge, busy, other, simulated,
            // checksum of the calibration
            Self::Axia => Bits { saturated: 1 << 30 | 1 << 27, warning: 1 << 16, error: 0x3000_002F, summary: 1 << 31 },
            // overload Fx to Tz; sensor missing or failed, converter or its connection failed; number of the sensor that
            // something is wrong with, and whether there are more
            Self::OnRobot => Bits { saturated: 0x03F0, warning: 0, error: 0xFC00, summary: 0x000F },
        }
    }

    /// What a status word says of its sample. Bits that are not known are a warning, together with the bit for any error an
    /// error.
    pub fn quality(self, status: u32) -> Quality {
        let Bits { saturated, warning, error, summary } = self.bits();
        let unknown = status & !(saturated | warning | error | summary);
        let unexplained = status & summary != 0 && (unknown != 0 || status & !summary == 0);
        let mut quality = Quality::empty();
        quality.set(Quality::SATURATED, status & saturated != 0);
        quality.set(Quality::DEVICE_WARNING, status & warning != 0 || unknown != 0);
        quality.set(Quality::DEVICE_ERROR, status & error != 0 || unexplained);
        quality
    }
}

/// Interval of the requests to start, s: these datagrams can get lost, too.
const RETRY: f64 = 0.1;

/// A packet that more than this many others overtook is not late: the device restarted its counter.
const OVERTAKEN: i64 = 256;

/// The second record after a restart is less than so many samples behind the first.
const NEXT: u32 = 1000;

/// How a sensor is asked, and what is known of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RdtSettings {
    /// Its family.
    pub profile: RdtProfile,
    /// Rate of its own clock, Hz, if it is to tell the time of the samples: that of `ft_sequence`, 7000 for most Net F/T (its
    /// `netftapi2.xml` calls it `runrate`), which may be more than the rate of the records.
    pub clock_rate: Option<f64>,
    /// So long without a datagram, s, and it is asked to start again, as after its power was off. More than twice the distance
    /// of its records.
    pub silence: f64,
}

impl RdtSettings {
    /// Started again after 1 s, time by the host.
    pub fn new(profile: RdtProfile) -> Self {
        Self { profile, clock_rate: None, silence: 1.0 }
    }
}

/// The stream of an RDT sensor (ATI Net F/T and Axia, OnRobot): starts it, again every 0.1 s until data comes and after a
/// silence, decodes its records, and keeps account of what is missing.
///
/// A sample has the counts of Fx, Fy, Fz, Tx, Ty, Tz as its channels, `ft_sequence` as its number, which goes up by more than 1
/// where the records are fewer than the samples of the sensor's clock, and the status word as sent.
/// Two counters tell more than one: each start makes `rdt_sequence` begin at 1 again, `ft_sequence` goes on. So
/// - a record of the same sample as the one before is a repetition, whatever the number of its packet;
/// - an earlier packet with a later sample is the answer to one more start, and nothing is lost;
/// - an earlier sample is late, or the device restarted: two in a row that follow each other, not among the last 256
///   packets, are a restart. The first of them is left out;
/// - after a silence, or where the connection is re-established, the first sample is [`Quality::RESTARTED`], unless the clock of the
///   device went on with that of the host (`clock_rate`): without power it has lost its zero.
///
/// ```
/// use rod_hw::{Protocol, device::rdt::{Rdt, RdtProfile, RdtRecord, RdtSettings}};
/// let mut rdt = Rdt::new(RdtSettings { clock_rate: Some(7000.0), ..RdtSettings::new(RdtProfile::NetFt) });
/// assert_eq!(rdt.request(0.0).as_deref(), Some(&[0x12, 0x34, 0, 2, 0, 0, 0, 0][..]));
/// let mut take = |packet, sample, now| {
///     let bytes = RdtRecord { packet, sample, status: 0, counts: [100, -200, 300, 10, -20, 30] }.to_bytes();
///     rdt.decode(&mut &bytes[..], now)
/// };
/// let first = take(1, 700, 0.05).ok_or("nothing")??;
/// assert_eq!((first.channels[1], first.sequence, first.device_time), (-200.0, Some(700), Some(0.1)));
/// let second = take(4, 703, 0.06).ok_or("nothing")??;
/// assert_eq!(second.quality.to_string(), "gap before");
/// assert_eq!(rdt.counters().lost, 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Rdt {
    settings: RdtSettings,
    stream: Stream,
    packets: Sequence,
    samples: Sequence,
    /// How far the sample goes from packet to packet.
    stride: Option<i64>,
    /// A record that the device may have restarted with.
    candidate: Option<RdtRecord>,
    /// For the next sample.
    flags: Quality,
    /// Sample number and device time that the times are counted from.
    origin: (u64, f64),
    /// Time by the host and by the device of the last sample.
    last: Option<(f64, f64)>,
    counters: LinkCounters,
}

#[derive(Clone, Copy, Debug)]
enum Stream {
    /// To be asked for; when that was done last.
    Waiting { started: Option<f64> },
    /// Records come; since when there are none although asked for.
    Running { quiet: Option<f64> },
}

/// The meaning of the counters of a record.
enum Verdict {
    /// To be handed on; so many are missing before it, and whether the device restarted.
    Take {
        lost: i64,
        restarted: bool,
    },
    Repeated,
    Late,
}

impl Rdt {
    /// A stream that is not started yet.
    pub fn new(settings: RdtSettings) -> Self {
        Self {
            settings,
            stream: Stream::Waiting { started: None },
            packets: Sequence::new(32),
            samples: Sequence::new(Self::sample_bits(settings.profile)),
            stride: None,
            candidate: None,
            flags: Quality::empty(),
            origin: (0, 0.0),
            last: None,
            counters: LinkCounters::default(),
        }
    }

    /// OptoForce's manual speaks of a counter of 16 bits in a field of 32: its low half is right in either case.
    const fn sample_bits(profile: RdtProfile) -> u32 {
        match profile {
            RdtProfile::NetFt | RdtProfile::Axia => 32,
            RdtProfile::OnRobot => 16,
        }
    }

    /// Whether the clock of the device went on with that of the host since the last sample, within 1 % and 50 ms: then its
    /// power was on all the time.
    fn clock_went_on(&self, ahead: i64, now: f64) -> bool {
        let Some((rate, (then, _))) = self.settings.clock_rate.zip(self.last) else { return false };
        let elapsed = now - then;
        // a counter that may have wrapped proves nothing
        let wraps = (1_u64 << (Self::sample_bits(self.settings.profile) - 1)) as f64 / rate;
        ahead > 0 && elapsed < wraps && (ahead as f64 / rate - elapsed).abs() < 0.05 + 0.01 * elapsed
    }

    /// The meaning of the counters of a record.
    fn judge(&mut self, record: &RdtRecord, now: f64) -> Verdict {
        let candidate = self.candidate.take();
        let waiting = matches!(self.stream, Stream::Waiting { .. });
        self.stream = Stream::Running { quiet: None };
        let (Some(packet), Some(sample)) = (self.packets.ahead(record.packet), self.samples.ahead(record.sample))
        else {
            return Verdict::Take { lost: 0, restarted: false };
        };
        if waiting {
            self.flags |= Quality::GAP_BEFORE;
            if !self.clock_went_on(sample, now) {
                self.flags |= Quality::RESTARTED;
            }
            self.counters.gaps += 1;
            self.packets.advance(record.packet);
            return match sample {
                0 => Verdict::Repeated,
                ahead => Verdict::Take { lost: 0, restarted: ahead < 0 },
            };
        }
        match (packet, sample) {
            (1.., 1..) => {
                if packet == 1 {
                    self.stride = Some(sample);
                }
                Verdict::Take { lost: packet - 1, restarted: false }
            }
            (1.., 0) => {
                self.miss(packet - 1);
                self.packets.advance(record.packet);
                Verdict::Repeated
            }
            (0, 0) => Verdict::Repeated,
            // one more start was answered
            (_, 1..) => {
                if self.stride.is_none_or(|stride| sample > stride) {
                    self.flags |= Quality::GAP_BEFORE;
                    self.counters.gaps += 1;
                }
                Verdict::Take { lost: 0, restarted: false }
            }
            (..=-1, 0) => Verdict::Late,
            _ => {
                let follows = |first: RdtRecord| {
                    record.packet == first.packet.wrapping_add(1)
                        && record.sample.wrapping_sub(first.sample).wrapping_sub(1) < NEXT
                };
                if !(-OVERTAKEN..=0).contains(&packet) && candidate.is_some_and(follows) {
                    Verdict::Take { lost: if packet > 0 { packet - 1 } else { 1 }, restarted: true }
                } else {
                    self.candidate = Some(*record);
                    Verdict::Late
                }
            }
        }
    }

    /// So many samples are missing.
    fn miss(&mut self, lost: i64) {
        if let Ok(lost @ 1..) = u64::try_from(lost) {
            self.counters.lost += lost;
            self.counters.gaps += 1;
            self.flags |= Quality::GAP_BEFORE;
        }
    }

    /// The sample of a record, if it is to be handed on.
    fn sample(&mut self, mut record: RdtRecord, now: f64) -> Option<RawSample> {
        record.sample &= u32::MAX >> (32 - Self::sample_bits(self.settings.profile));
        match self.judge(&record, now) {
            Verdict::Take { lost, restarted } => {
                self.miss(lost);
                if restarted {
                    self.counters.restarts += 1;
                    self.flags |= Quality::RESTARTED | Quality::GAP_BEFORE;
                }
                self.packets.advance(record.packet);
                self.samples.advance(record.sample);
                if let Some((then, time)) = self.last.filter(|_| restarted) {
                    self.origin = (self.samples.unwrapped(), time + (now - then));
                }
            }
            Verdict::Repeated => {
                self.counters.repeated += 1;
                return None;
            }
            Verdict::Late => {
                self.counters.reordered += 1;
                return None;
            }
        }
        let sequence = self.samples.unwrapped();
        let (from, origin) = self.origin;
        let rate = self.settings.clock_rate.filter(|rate| *rate > 0.0);
        let device_time = rate.map(|rate| origin + sequence.saturating_sub(from) as f64 / rate);
        self.last = Some((now, device_time.unwrap_or(now)));
        let quality = take(&mut self.flags) | self.settings.profile.quality(record.status);
        self.counters.samples += 1;
        self.counters.device_errors += u64::from(quality.intersects(Quality::SATURATED | Quality::DEVICE_ERROR));
        Some(RawSample {
            sequence: Some(sequence),
            device_time,
            status: record.status,
            quality,
            ..RawSample::new(now, Channels::from(record.counts.map(f64::from)))
        })
    }
}

impl Protocol for Rdt {
    fn decode(&mut self, bytes: &mut &[u8], now: f64) -> Option<Result<RawSample, FrameFault>> {
        let datagram = take(bytes);
        if datagram.is_empty() {
            return None;
        }
        let Ok(record) = datagram.try_into() else {
            self.counters.malformed += 1;
            return Some(Err(FrameFault::Length { found: datagram.len(), expected: RdtRecord::BYTES }));
        };
        self.sample(RdtRecord::from_bytes(record), now).map(Ok)
    }

    fn request(&mut self, now: f64) -> Option<Request> {
        match &mut self.stream {
            // that nobody asked for samples is no silence of the device
            Stream::Running { quiet: quiet @ None } => {
                *quiet = Some(now);
                return None;
            }
            Stream::Running { quiet: Some(since) } if now - *since < self.settings.silence => return None,
            Stream::Waiting { started: Some(at) } if now - *at < RETRY => return None,
            _ => self.stream = Stream::Waiting { started: Some(now) },
        }
        Some(RdtRequest::Start { count: 0 }.into())
    }

    fn farewell(&self) -> Option<Request> {
        Some(RdtRequest::Stop.into())
    }

    fn reset(&mut self) {
        self.stream = Stream::Waiting { started: None };
        self.candidate = None;
    }

    fn counters(&self) -> LinkCounters {
        self.counters
    }
}
