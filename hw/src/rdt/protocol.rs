//! The stream of a sensor.

use super::profile::RdtProfile;
use super::record::RdtRecord;
use super::request::{OnRobotFilter, RdtRequest};
use crate::counters::LinkCounters;
use crate::protocol::{FrameFault, Protocol, Request};
use crate::quality::Quality;
use crate::raw::{Channels, RawSample};
use crate::sequence::Sequence;
use core::mem::take;
use core::num::NonZeroU8;

/// Distance of the requests to start, s: datagrams get lost, these too.
const RETRY: f64 = 0.1;

/// A packet overtaken by more others than this is not a late one but of a device that counts anew.
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
    /// Whether to ask for several records a datagram.
    pub buffered: bool,
    /// So long without a datagram, s, and it is asked to start again, as after its power was off. More than twice the distance
    /// of its records.
    pub silence: f64,
    /// Filter to set, OnRobot only: it forgets it without power.
    pub filter: Option<OnRobotFilter>,
    /// Distance of the records to set, ms, OnRobot only: it forgets it without power.
    pub period: Option<NonZeroU8>,
}

impl RdtSettings {
    /// One record a datagram, started again after 1 s, time by the host.
    pub fn new(profile: RdtProfile) -> Self {
        Self { profile, clock_rate: None, buffered: false, silence: 1.0, filter: None, period: None }
    }
}

/// Why a request is not made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RdtRequestError {
    /// Another family's, which this one may take for something else.
    #[error("{request:?} is no request to {profile:?}; see RdtRequest for whose it is")]
    Profile {
        /// The request.
        request: RdtRequest,
        /// The family of the sensor.
        profile: RdtProfile,
    },
    /// The last one has not been sent yet.
    #[error("{request:?} comes before {waiting:?} was sent; ask for a sample in between")]
    Busy {
        /// The request.
        request: RdtRequest,
        /// The one before.
        waiting: RdtRequest,
    },
}

/// The stream of an RDT sensor (ATI Net F/T and Axia, OnRobot): starts it, again every 0.1 s until data comes and after a
/// silence, decodes its records, and keeps account of what is missing.
///
/// A sample has the counts of Fx, Fy, Fz, Tx, Ty, Tz as its channels, `ft_sequence` as its number, which goes up by more than 1
/// where the records are fewer than the samples of the sensor's clock, and the status word as sent.
/// Two counters tell more than one: each start makes `rdt_sequence` begin at 1 again, `ft_sequence` goes on. So
/// - a record of the same sample as the one before is a repetition, whatever the number of its packet;
/// - an earlier packet with a later sample is the answer to one more start, and nothing is lost;
/// - an earlier sample is late, or the device started anew: two in a row that follow each other, not among the last 256
///   packets, are a restart. The first of them is left out;
/// - after a silence, or where the connection is made anew, the first sample is [`Quality::RESTARTED`], unless the clock of the
///   device went on with that of the host (`clock_rate`): without power it has lost its zero.
///
/// All records of a datagram have the same time of arrival.
///
/// ```
/// use rod_hw::{Protocol, rdt::{Rdt, RdtProfile, RdtRecord, RdtSettings}};
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
    /// A record that the device may have started anew with.
    candidate: Option<RdtRecord>,
    /// For the next sample.
    flags: Quality,
    /// Sample number and device time that the times are counted from.
    origin: (u64, f64),
    /// Time by the host and by the device of the last sample.
    last: Option<(f64, f64)>,
    asked: Option<RdtRequest>,
    counters: LinkCounters,
}

#[derive(Clone, Copy, Debug)]
enum Stream {
    /// To be asked for: which request is next, and when the last start was sent.
    Waiting { next: usize, started: Option<f64> },
    /// Records come; since when there are none although asked for.
    Running { quiet: Option<f64> },
}

/// What the numbers of a record say.
enum Verdict {
    /// To be handed on; so many are missing before it, and whether the device began anew.
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
            stream: Stream::Waiting { next: 0, started: None },
            packets: Sequence::new(32, 1),
            samples: Sequence::new(Self::sample_bits(settings.profile), 1),
            stride: None,
            candidate: None,
            flags: Quality::empty(),
            origin: (0, 0.0),
            last: None,
            asked: None,
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

    /// How the sensor is asked.
    pub fn settings(&self) -> &RdtSettings {
        &self.settings
    }

    /// Makes a request with the next sample that is asked for. After a new zero the next sample is [`Quality::RESTARTED`], as
    /// an earlier tare is none any more; what was on its way still has the old zero.
    ///
    /// # Errors
    /// [`RdtRequestError`].
    pub fn ask(&mut self, request: RdtRequest) -> Result<(), RdtRequestError> {
        use RdtRequest::{ClearBias, Filter, Period, ResetLatch, StartBuffered};
        let profile = self.settings.profile;
        let theirs = match request {
            ClearBias | Filter(_) | Period(_) => profile != RdtProfile::OnRobot,
            StartBuffered { .. } | ResetLatch => profile == RdtProfile::OnRobot,
            _ => false,
        };
        if theirs {
            return Err(RdtRequestError::Profile { request, profile });
        }
        if let Some(waiting) = self.asked {
            return Err(RdtRequestError::Busy { request, waiting });
        }
        self.asked = Some(request);
        Ok(())
    }

    /// What to ask one after the other, the start at the end.
    fn start(&self) -> [Option<RdtRequest>; 3] {
        let RdtSettings { profile, buffered, filter, period, .. } = self.settings;
        let on_robot = profile == RdtProfile::OnRobot;
        [
            filter.filter(|_| on_robot).map(RdtRequest::Filter),
            period.filter(|_| on_robot).map(RdtRequest::Period),
            Some(if buffered { RdtRequest::StartBuffered { count: 0 } } else { RdtRequest::Start { count: 0 } }),
        ]
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

    /// What the numbers of a record say.
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
        while !bytes.is_empty() {
            let found = bytes.len();
            let whole =
                if self.settings.buffered { found.is_multiple_of(RdtRecord::BYTES) } else { found == RdtRecord::BYTES };
            let Some((record, rest)) = bytes.split_first_chunk().filter(|_| whole) else {
                *bytes = &[];
                self.counters.malformed += 1;
                return Some(Err(FrameFault::Length { found, expected: RdtRecord::BYTES }));
            };
            *bytes = rest;
            if let Some(sample) = self.sample(RdtRecord::from_bytes(record), now) {
                return Some(Ok(sample));
            }
        }
        None
    }

    fn request(&mut self, now: f64) -> Option<Request> {
        if let Some(asked) = self.asked.take() {
            if matches!(asked, RdtRequest::Bias | RdtRequest::ClearBias) {
                self.flags |= Quality::RESTARTED;
            }
            return Some(asked.into());
        }
        match &mut self.stream {
            // that nobody asked for samples is no silence of the device
            Stream::Running { quiet: quiet @ None } => {
                *quiet = Some(now);
                return None;
            }
            Stream::Running { quiet: Some(since) } if now - *since < self.settings.silence => return None,
            Stream::Running { .. } => self.stream = Stream::Waiting { next: 0, started: None },
            Stream::Waiting { started: Some(at), .. } if now - *at < RETRY => return None,
            Stream::Waiting { .. } => {}
        }
        let requests = self.start();
        let Stream::Waiting { next, started } = &mut self.stream else { return None };
        let (place, request) = requests.iter().enumerate().skip(*next).find_map(|(i, r)| r.map(|r| (i, r)))?;
        if place + 1 == requests.len() {
            (*next, *started) = (0, Some(now));
        } else {
            (*next, *started) = (place + 1, None);
        }
        Some(request.into())
    }

    fn farewell(&self) -> Option<Request> {
        Some(RdtRequest::Stop.into())
    }

    fn reset(&mut self) {
        self.stream = Stream::Waiting { next: 0, started: None };
        self.candidate = None;
    }

    fn counters(&self) -> LinkCounters {
        self.counters
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A stream that is running, and what it makes of packet and sample numbers at 1 ms.
    struct Bench(Rdt, f64);

    impl Bench {
        fn new(settings: RdtSettings) -> Self {
            let mut rdt = Rdt::new(settings);
            assert!(rdt.request(0.0).is_some());
            Self(rdt, 0.0)
        }

        fn put(&mut self, packet: u32, sample: u32) -> Option<RawSample> {
            self.1 += 1e-3;
            let bytes = RdtRecord { packet, sample, ..RdtRecord::default() }.to_bytes();
            self.0.decode(&mut &bytes[..], self.1).map(Result::unwrap)
        }

        /// Numbers of the samples handed on, and their flags.
        fn all(&mut self, records: &[(u32, u32)]) -> Vec<(u64, Quality)> {
            let taken = records.iter().filter_map(|&(packet, sample)| self.put(packet, sample));
            taken.map(|raw| (raw.sequence.unwrap(), raw.quality)).collect()
        }
    }

    fn net_ft() -> RdtSettings {
        RdtSettings::new(RdtProfile::NetFt)
    }

    const GOOD: Quality = Quality::empty();
    const GAP: Quality = Quality::GAP_BEFORE;

    #[test]
    fn a_late_record_is_not_four_billion_lost() {
        let mut bench = Bench::new(net_ft());
        let taken = bench.all(&[(1, 10), (3, 30), (2, 20), (4, 40), (4, 40), (5, 50)]);
        assert_eq!(taken, [(10, GOOD), (30, GAP), (40, GOOD), (50, GOOD)]);
        let LinkCounters { samples, lost, gaps, reordered, repeated, restarts, .. } = bench.0.counters();
        assert_eq!((samples, lost, gaps, reordered, repeated, restarts), (4, 1, 1, 1, 1, 0));
    }

    #[test]
    fn records_overtaken_together_are_no_restart() {
        let mut bench = Bench::new(net_ft());
        let taken = bench.all(&[(10, 10), (14, 14), (11, 11), (12, 12), (13, 13), (15, 15)]);
        assert_eq!(taken, [(10, GOOD), (14, GAP), (15, GOOD)]);
        let counters = bench.0.counters();
        assert_eq!((counters.lost, counters.reordered, counters.restarts), (3, 3, 0));
    }

    #[test]
    fn one_more_start_is_no_loss() {
        let mut bench = Bench::new(net_ft());
        let taken = bench.all(&[(1, 7), (2, 14), (3, 21), (1, 28), (2, 35), (3, 42)]);
        assert_eq!(taken.iter().map(|(number, _)| *number).collect::<Vec<_>>(), [7, 14, 21, 28, 35, 42]);
        assert!(taken.iter().all(|(_, quality)| quality.is_empty()));
        // the first record of either start has number 1
        let mut bench = Bench::new(net_ft());
        assert_eq!(bench.all(&[(1, 7), (1, 70)]), [(7, GOOD), (70, GAP)]);
        assert_eq!(bench.0.counters().lost + bench.0.counters().repeated, 0);
    }

    #[test]
    fn a_stalled_sensor_repeats_its_sample() {
        let mut bench = Bench::new(net_ft());
        assert_eq!(bench.all(&[(1, 7), (2, 7), (4, 7), (5, 14)]), [(7, GOOD), (14, GAP)]);
        assert_eq!((bench.0.counters().repeated, bench.0.counters().lost), (2, 1));
    }

    #[test]
    fn a_device_that_counts_anew() {
        let restarted = Quality::RESTARTED | GAP;
        // its packets go on
        let mut bench = Bench::new(net_ft());
        let taken = bench.all(&[(1, 90_000), (2, 90_001), (3, 1), (4, 2), (5, 3)]);
        assert_eq!(taken, [(90_000, GOOD), (90_001, GOOD), (90_002, restarted), (90_003, GOOD)]);
        assert_eq!((bench.0.counters().restarts, bench.0.counters().lost, bench.0.counters().reordered), (1, 1, 1));
        // they begin anew, too
        let mut bench = Bench::new(net_ft());
        assert_eq!(bench.all(&[(5000, 90_000), (1, 1), (2, 2)]), [(90_000, GOOD), (90_001, restarted)]);
    }

    #[test]
    fn counters_wrap() {
        let mut bench = Bench::new(RdtSettings { clock_rate: Some(1.0), ..net_ft() });
        let taken = bench.all(&[(u32::MAX, u32::MAX - 1), (0, u32::MAX), (1, 0), (3, 2)]);
        let from = u64::from(u32::MAX) - 1;
        assert_eq!(taken, [(from, GOOD), (from + 1, GOOD), (from + 2, GOOD), (from + 4, GAP)]);
        assert_eq!(bench.0.counters().lost, 1);
        // 16 bits of OnRobot
        let mut bench = Bench::new(RdtSettings::new(RdtProfile::OnRobot));
        assert_eq!(bench.all(&[(1, 65_535), (2, 0), (3, 65_537)]), [(65_535, GOOD), (65_536, GOOD), (65_537, GOOD)]);
    }

    #[test]
    fn started_until_data_comes_and_after_a_silence() {
        let settings = RdtSettings { filter: Some(OnRobotFilter::None), period: NonZeroU8::new(2), ..net_ft() };
        let mut rdt = Rdt::new(RdtSettings { profile: RdtProfile::OnRobot, ..settings });
        let commands = |rdt: &mut Rdt, from: f64, to: f64| -> Vec<u8> {
            let times = (0..).map(|i| from + 0.01 * f64::from(i)).take_while(|t| *t < to);
            times.filter_map(|t| rdt.request(t)).map(|request| request[3]).collect()
        };
        assert_eq!(commands(&mut rdt, 0.0, 0.28), [0x81, 0x82, 2, 0x81, 0x82, 2, 0x81, 0x82, 2]);
        // not of OnRobot: the start alone, at 0, 0.1, 0.2 s
        let mut bench = Bench::new(settings);
        assert_eq!(commands(&mut bench.0, 0.0, 0.25), [2, 2]);
        bench.all(&[(1, 1)]);
        assert_eq!(commands(&mut bench.0, 0.3, 1.25), []);
        // the reader slept for long, there is data all the same
        bench.all(&[(2, 2)]);
        assert_eq!(commands(&mut bench.0, 9.0, 9.9), []);
        assert_eq!(commands(&mut bench.0, 9.9, 10.15), [2, 2]);
        assert_eq!(bench.all(&[(1, 3)]), [(3, Quality::RESTARTED | GAP)]);
        // asked to by the link
        bench.0.reset();
        assert_eq!(commands(&mut bench.0, 10.2, 10.25), [2]);
        assert_eq!(bench.0.farewell().as_deref(), Some(&RdtRequest::Stop.to_bytes()[..]));
    }

    #[test]
    fn a_clock_that_went_on_vouches_for_the_zero() {
        for (sample, went_on) in [(3000, true), (300, false), (9000, false), (1, false)] {
            let mut bench = Bench::new(RdtSettings { clock_rate: Some(1000.0), ..net_ft() });
            bench.put(1, 1000).unwrap();
            bench.0.reset();
            bench.1 += 2.0;
            let raw = bench.put(1, sample).unwrap();
            assert_eq!(!raw.quality.contains(Quality::RESTARTED), went_on, "{sample}");
            assert!(raw.quality.contains(GAP));
            // the time of the device goes on either way
            assert!(raw.device_time.unwrap() > 1.0);
            assert_eq!(bench.0.counters().restarts, u64::from(sample < 1000));
        }
    }

    #[test]
    fn requests_in_between() {
        let mut bench = Bench::new(net_ft());
        bench.put(1, 1);
        let rdt = &mut bench.0;
        let refused = rdt.ask(RdtRequest::ClearBias).unwrap_err().to_string();
        assert_eq!(refused, "ClearBias is no request to NetFt; see RdtRequest for whose it is");
        rdt.ask(RdtRequest::Bias).unwrap();
        assert!(matches!(rdt.ask(RdtRequest::ResetLatch), Err(RdtRequestError::Busy { .. })));
        assert_eq!(rdt.request(0.01).as_deref(), Some(&RdtRequest::Bias.to_bytes()[..]));
        assert_eq!(rdt.request(0.02), None);
        assert_eq!(bench.all(&[(2, 2), (3, 3)]), [(2, Quality::RESTARTED), (3, GOOD)]);
    }

    #[test]
    fn several_records_a_datagram() {
        let settings = RdtSettings { buffered: true, ..net_ft() };
        let mut rdt = Rdt::new(settings);
        assert_eq!(rdt.request(0.0).as_deref(), Some(&RdtRequest::StartBuffered { count: 0 }.to_bytes()[..]));
        let record = |packet| RdtRecord { packet, sample: packet, ..RdtRecord::default() }.to_bytes();
        let datagram: Vec<u8> = [1, 2, 2, 4].into_iter().flat_map(record).collect();
        let mut bytes = &datagram[..];
        let mut numbers = Vec::new();
        while let Some(sample) = rdt.decode(&mut bytes, 0.0) {
            numbers.push(sample.unwrap().sequence.unwrap());
        }
        assert_eq!(numbers, [1, 2, 4]);
        // a datagram with a part of a record is not trusted at all
        let mut bytes = &datagram[..143];
        assert_eq!(rdt.decode(&mut bytes, 0.0), Some(Err(FrameFault::Length { found: 143, expected: 36 })));
        assert!(bytes.is_empty());
        // without having asked for it
        let mut rdt = Rdt::new(net_ft());
        assert!(rdt.decode(&mut &datagram[..72], 0.0).unwrap().is_err());
    }

    proptest! {
        #[test]
        fn any_bytes(datagrams in proptest::collection::vec(proptest::collection::vec(any::<u8>(), 0..200), 0..20), buffered: bool) {
            let mut rdt = Rdt::new(RdtSettings { buffered, ..net_ft() });
            let mut records = 0;
            for datagram in &datagrams {
                let mut bytes = &datagram[..];
                while !bytes.is_empty() {
                    let before = bytes.len();
                    let decoded = rdt.decode(&mut bytes, 0.0);
                    prop_assert!(bytes.len() < before || decoded.is_none());
                }
                let whole = if buffered { datagram.len().is_multiple_of(36) } else { datagram.len() == 36 };
                records += if whole { datagram.len() / 36 } else { usize::from(!datagram.is_empty()) };
            }
            let counters = rdt.counters();
            let accounted = counters.samples + counters.repeated + counters.reordered + counters.malformed;
            prop_assert_eq!(accounted, records as u64);
        }

        #[test]
        fn any_numbers(numbers in proptest::collection::vec((any::<u8>(), any::<u8>(), any::<bool>()), 0..200)) {
            // low numbers and some near the wrap, so that all cases come up
            let mut bench = Bench::new(RdtSettings { clock_rate: Some(100.0), ..net_ft() });
            let (mut last, mut time) = (0, f64::NEG_INFINITY);
            for (packet, sample, high) in numbers {
                let place = |n: u8| if high { u32::MAX - u32::from(n) } else { u32::from(n) };
                if let Some(raw) = bench.put(place(packet), place(sample)) {
                    let (number, now) = (raw.sequence.unwrap(), raw.device_time.unwrap());
                    prop_assert!(number > last || time == f64::NEG_INFINITY);
                    prop_assert!(now > time);
                    (last, time) = (number, now);
                }
            }
        }
    }
}
