//! A fake device on a stream.

use super::{FakeDevice, Script};
use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

/// Bytes that are kept for a host that does not read, if nothing else is said.
const ROOM: usize = 1 << 16;

/// So many frames at a time, then the host is heard again.
const BATCH: usize = 64;

/// A fake device that sends what a source yields: an iterator of values (`[f64; 6]`, `Vec<f64>`, ...), one item a sample.
///
/// ```
/// use rod_fake_sensor::{End, FakeBota, FakeSensor, Fault, Pace, Script};
/// use rod_hw::device::framed::{Bota, Framed};
/// use rod_hw::{Protocol, Quality};
/// use std::io::Read;
/// use std::net::{TcpListener, TcpStream};
/// use std::time::Duration;
/// let listener = TcpListener::bind("127.0.0.1:0")?;
/// let mut host = TcpStream::connect(listener.local_addr()?)?;
/// let (mut device, _) = listener.accept()?;
/// device.set_read_timeout(Some(Duration::from_millis(1)))?;
/// let thread = std::thread::spawn(move || {
///     let source = (0..100).map(|i| [f64::from(i), 0.0, 0.0, 0.0, 0.0, 0.0]);
///     let script = Script::new().at(7, Fault::Report(Quality::SATURATED)).at(9, Fault::Flip(100));
///     let mut sensor = FakeSensor::new(FakeBota::new(200.0), source).with_script(script).with_pace(Pace::Unpaced);
///     sensor.serve(&mut device, |_| true)
/// });
/// let (mut bytes, mut samples) = (Vec::new(), Vec::new());
/// host.read_to_end(&mut bytes)?;
/// let (mut protocol, mut rest) = (Framed::new(Bota), &bytes[..]);
/// while let Some(told) = protocol.decode(&mut rest, 0.0) {
///     samples.extend(told.ok());
/// }
/// assert_eq!(samples.len(), 99);
/// assert_eq!(samples[7].quality, Quality::SATURATED);
/// assert_eq!((samples[9].channels[0], samples[9].quality), (10.0, Quality::GAP_BEFORE));
/// assert_eq!(thread.join().expect("no panic")?, End::Source);
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct FakeSensor<D, S> {
    device: D,
    source: S,
    script: Script,
    pace: Pace,
    room: usize,
    served: Served,
    /// The frame before which it was unplugged last.
    unplugged: Option<u64>,
}

/// How fast frames are sent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// As the device is set to. What the host does not read in time is lost.
    Device,
    /// At this rate, Hz, whatever the device is set to. What the host does not read in time is lost.
    Rate(f64),
    /// As fast as the host reads.
    Unpaced,
}

/// The account of a fake device so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Served {
    /// Samples measured.
    pub frames: u64,
    /// Frames not sent because of the script.
    pub lost: u64,
    /// Frames not sent because the host does not read.
    pub overrun: u64,
}

/// Why a fake device stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The source has ended.
    Source,
    /// The script unplugs it: drop the stream, and serve another one.
    Unplugged,
    /// The host closed the connection.
    Closed,
    /// On request.
    Told,
}

impl<D: FakeDevice, S: Iterator<Item: AsRef<[f64]>>> FakeSensor<D, S> {
    /// A device that sends what the source yields, at its own rate, and never fails.
    pub fn new(device: D, source: S) -> Self {
        let (script, pace, served, unplugged) = (Script::new(), Pace::Device, Served::default(), None);
        Self { device, source, script, pace, room: ROOM, served, unplugged }
    }

    /// With this going wrong.
    #[must_use]
    pub fn with_script(mut self, script: Script) -> Self {
        self.script = script;
        self
    }

    /// At this pace.
    #[must_use]
    pub fn with_pace(mut self, pace: Pace) -> Self {
        self.pace = pace;
        self
    }

    /// With room for so many bytes that the host has not read yet, 65,536 by default; frames beyond are lost. More room bridges
    /// longer pauses of the host, as on a busy machine.
    #[must_use]
    pub fn with_room(mut self, bytes: usize) -> Self {
        self.room = bytes;
        self
    }

    /// The account so far.
    pub fn served(&self) -> Served {
        self.served
    }

    /// Serves a host until there is a reason to end, or `go_on` says no. Reads and writes of the stream must come back when
    /// there is nothing to do, after about 1 ms. Called again, it goes on with the next frame.
    ///
    /// # Errors
    /// Those of the stream.
    pub fn serve<RW: Read + Write>(
        &mut self,
        stream: &mut RW,
        mut go_on: impl FnMut(&Served) -> bool,
    ) -> io::Result<End> {
        let mut pending = Vec::new();
        let mut buffer = [0; 256];
        // since when it sends at which rate, and how many frames that was
        let mut run: Option<(Instant, f64, u64)> = None;
        loop {
            if !go_on(&self.served) {
                return Ok(End::Told);
            }
            match stream.read(&mut buffer) {
                Ok(0) => return Ok(End::Closed),
                Ok(count) => self.device.hear(buffer.get(..count).unwrap_or_default(), &mut pending),
                Err(error) if is_idle(&error) => {}
                Err(error) => return closed(error),
            }
            let rate = match self.pace {
                Pace::Rate(rate) => rate,
                Pace::Device | Pace::Unpaced => self.device.rate(),
            };
            run = run.filter(|run| self.device.is_sending() && run.1 == rate);
            if run.is_none() && self.device.is_sending() {
                run = Some((Instant::now(), rate, 0));
            }
            let due = match &run {
                None => 0,
                Some(_) if self.pace == Pace::Unpaced && pending.is_empty() => BATCH,
                Some(_) if self.pace == Pace::Unpaced => 0,
                Some((since, rate, sent)) => {
                    let due = (since.elapsed().as_secs_f64() * rate) as u64 + 1;
                    usize::try_from(due.saturating_sub(*sent)).unwrap_or(BATCH).min(BATCH)
                }
            };
            for _ in 0..due.max(usize::from(self.device.take_single())) {
                let end = self.measure(&mut pending);
                if let Some(run) = &mut run {
                    run.2 += 1;
                }
                if let Some(end) = end {
                    self.finish(stream, &mut pending)?;
                    return Ok(end);
                }
            }
            match self.write(stream, &mut pending) {
                Ok(()) => {}
                Err(error) => return closed(error),
            }
            if due < BATCH && pending.is_empty() {
                std::thread::sleep(Duration::from_micros(200));
            }
        }
    }

    /// The next frame, with what is wrong with it.
    fn measure(&mut self, pending: &mut Vec<u8>) -> Option<End> {
        let frame = self.served.frames;
        if self.script.disconnects(frame) && self.unplugged != Some(frame) {
            self.unplugged = Some(frame);
            self.device.restart();
            return Some(End::Unplugged);
        }
        let Some(values) = self.source.next() else { return Some(End::Source) };
        let mut bytes = Vec::new();
        self.device.measure(values.as_ref(), self.script.quality(frame), &mut bytes);
        self.served.frames += 1;
        match self.script.damaged(frame, bytes) {
            None => self.served.lost += 1,
            Some(_) if pending.len() > self.room => self.served.overrun += 1,
            Some(bytes) => pending.extend(bytes),
        }
        None
    }

    /// Writes as much as there is room for.
    fn write(&mut self, stream: &mut impl Write, pending: &mut Vec<u8>) -> io::Result<()> {
        let mut written = 0;
        let done = loop {
            match pending.get(written..) {
                None | Some([]) => break Ok(()),
                Some(rest) => match stream.write(rest) {
                    Ok(0) => break Err(ErrorKind::WriteZero.into()),
                    Ok(count) => written += count,
                    Err(error) if is_idle(&error) => break Ok(()),
                    Err(error) => break Err(error),
                },
            }
        };
        pending.drain(..written);
        done
    }

    /// Writes all, as long as the host reads at least now and then.
    fn finish(&mut self, stream: &mut impl Write, pending: &mut Vec<u8>) -> io::Result<()> {
        let mut last = Instant::now();
        while !pending.is_empty() && last.elapsed() < Duration::from_secs(1) {
            let before = pending.len();
            self.write(stream, pending)?;
            if pending.len() < before {
                last = Instant::now();
            }
        }
        Ok(())
    }
}

/// Whether the host has closed the connection, which is no error.
fn closed(error: io::Error) -> io::Result<End> {
    match error.kind() {
        ErrorKind::BrokenPipe | ErrorKind::ConnectionReset | ErrorKind::ConnectionAborted => Ok(End::Closed),
        _ => Err(error),
    }
}

/// Whether there was just nothing to read, or no room to write.
fn is_idle(error: &std::io::Error) -> bool {
    use std::io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), WouldBlock | TimedOut | Interrupted)
}
