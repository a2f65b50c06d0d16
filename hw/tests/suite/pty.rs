//! Fake devices on pseudo-terminals, read as serial ports. A pseudo-terminal has no baud rate: the fake keeps the pace that the
//! baud rate would allow.

use rod_fake_sensor::{
    End, FakeBota, FakeDevice, FakeGsv8, FakeOptoForce, FakeSensor, Fault, Pace, Script, Served, of_profile, open_pty,
};
use rod_hw::device::framed::{Bota, Framed, Gsv, OptoForce, Robotiq};
use rod_hw::{
    HostClock, Link, LinkError, LinkSettings, Protocol, Quality, RawSample, Reconnect, SerialPort, SerialProfile,
    TransportError,
};
use std::sync::mpsc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Longest wait for a sample, s: a busy machine may not let the fake run for seconds. Only a test that fails waits so long.
const PATIENCE: f64 = 60.0;

/// What a fake on a thread did: why it ended, and what it did so far.
type Done = JoinHandle<(End, Served)>;

/// Serves `frames` frames, whose first value is their number, on a new pseudo-terminal. It stays until the test lets go.
fn serve(
    device: impl FakeDevice + Send + 'static,
    frames: u32,
    pace: Pace,
    script: Script,
) -> (String, mpsc::Sender<()>, Done) {
    let mut pty = open_pty().unwrap();
    let path = pty.path().to_owned();
    let (hold, held) = mpsc::channel::<()>();
    let thread = std::thread::spawn(move || {
        // what sends by itself waits until it is listened to
        let _ = held.recv();
        let source = (0..frames).map(|i| [f64::from(i), 1.0, 2.0, 3.0, 4.0, 5.0]);
        // a busy machine may not let the host run for seconds, which must lose nothing
        let sensor = FakeSensor::new(device, source).with_pace(pace).with_script(script);
        let mut sensor = sensor.with_room(usize::MAX);
        let end = sensor.serve(&mut pty, |_| true).unwrap();
        // until then the far end is there
        let _ = held.recv();
        (end, sensor.served())
    });
    (path, hold, thread)
}

fn settings(deadline: f64) -> LinkSettings {
    LinkSettings { deadline, ..LinkSettings::default() }
}

type SerialLink<P> = Link<SerialPort, P, HostClock>;

fn link<P: Protocol>(path: &str, protocol: P, settings: LinkSettings) -> SerialLink<P> {
    Link::new(SerialPort::open(path, 115_200).unwrap(), protocol, HostClock::new(), settings)
}

fn told<P: Protocol>(link: &mut SerialLink<P>, count: usize) -> Vec<RawSample> {
    link.by_ref().take(count).map(|sample| sample.unwrap()).collect()
}

/// At the highest rate that the baud rate lets frames through, and as fast as the program reads.
#[test]
fn nothing_is_lost_at_the_highest_rate() {
    use SerialProfile::{Bota, Gsv6, Gsv8, OptoForce, Robotiq};
    let lengths = [(Gsv8, 28), (Gsv6, 28), (Bota, 37), (OptoForce, 22), (Robotiq, 16)];
    assert_eq!(lengths.map(|(profile, _)| profile), SerialProfile::ALL);
    let threads = lengths.map(|(profile, length)| std::thread::spawn(move || at_highest_rate(profile, length)));
    threads.into_iter().for_each(|thread| thread.join().unwrap());
}

fn at_highest_rate(profile: SerialProfile, length: u32) {
    // a byte is 10 bits on the line; for 3 s
    let highest = profile.baud() / 10 / length;
    let frames = 3 * highest;
    let (path, hold, thread) = serve(of_profile(profile, 100.0), frames, Pace::Rate(highest.into()), Script::new());
    let mut link = link(&path, profile.protocol(), settings(PATIENCE));
    hold.send(()).unwrap();
    let since = Instant::now();
    let samples = told(&mut link, frames as usize);
    let per = f64::from(frames) / since.elapsed().as_secs_f64();
    let name = profile.name();
    println!("{name}: {frames} frames of {length} bytes at {highest} Hz, {per:.0} a second read; {}", link.counters());
    let tells = |(i, sample): (usize, &RawSample)| {
        let number = match profile {
            // N in counts of 10 mN, up to the most that there are
            SerialProfile::Robotiq => (100 * i).min(32_767) as f64,
            _ => i as f64,
        };
        sample.channels[0] == number && sample.quality.is_empty()
    };
    assert!(samples.iter().enumerate().all(tells), "{name}");
    let counters = link.counters();
    assert_eq!((counters.samples, counters.skipped_bytes), (frames.into(), 0), "{name}");
    drop(hold);
    let (end, served) = thread.join().unwrap();
    assert_eq!((end, served.overrun, served.frames), (End::Source, 0, frames.into()), "{name}");
}

#[test]
fn as_fast_as_it_is_read() {
    let frames = 50_000;
    let (path, hold, thread) = serve(FakeBota::new(1000.0), frames, Pace::Unpaced, Script::new());
    let mut link = link(&path, Framed::new(Bota), settings(PATIENCE));
    hold.send(()).unwrap();
    let since = Instant::now();
    let samples = told(&mut link, frames as usize);
    println!("{:.0} frames of 37 bytes a second", f64::from(frames) / since.elapsed().as_secs_f64());
    assert!(samples.iter().enumerate().all(|(i, sample)| sample.channels[0] == i as f64));
    let last = samples.last().unwrap().device_time.unwrap();
    assert!((last - f64::from(frames - 1) * 1e-3).abs() < 1e-6, "{last}");
    drop(hold);
    assert_eq!(thread.join().unwrap().1.overrun, 0);
}

/// It is set up and started, and at the end it is stopped.
#[test]
fn set_up_and_stopped() {
    let (path, hold, thread) = serve(FakeGsv8::new(2, 500.0), 1 << 30, Pace::Device, Script::new());
    hold.send(()).unwrap();
    let mut link = link(&path, Framed::new(Gsv), settings(PATIENCE));
    let samples = told(&mut link, 20);
    assert_eq!(link.counters().answers, 3);
    assert_eq!((samples[0].channels.len(), samples[0].channels[0]), (2, 0.0));
    link.stop().unwrap();
    link.by_ref().for_each(drop); // what came before, then the end
    drop(link);
    std::thread::sleep(Duration::from_millis(50));
    let mut silent = SerialPort::open(&path, 115_200).unwrap();
    let heard = rod_hw::Transport::receive(&mut silent, &mut [0; 64], Duration::from_millis(50)).unwrap();
    assert_eq!(heard, None, "it was stopped");
    // the fake goes on waiting for a start until its source is empty, so it is left alone
    drop((hold, thread));
}

/// What the script did is what the counters tell.
#[test]
fn scripted_faults() {
    let script = Script::new()
        .every(50, Fault::Flip(150))
        .at(20, Fault::Lost)
        .at(70, Fault::Report(Quality::SATURATED))
        .at(80, Fault::Report(Quality::DEVICE_ERROR))
        .at(120, Fault::Cut(11))
        .at(170, Fault::Before(vec![0x33; 9]))
        .at(220, Fault::Within { at: 7, bytes: vec![1, 2, 3] });
    let (path, hold, thread) = serve(FakeOptoForce::new(6), 301, Pace::Unpaced, script);
    let mut link = link(&path, Framed::new(OptoForce), settings(0.5));
    hold.send(()).unwrap();
    let samples: Vec<RawSample> = link.by_ref().map_while(Result::ok).collect();
    let counters = link.counters();
    println!("{counters}");
    // the last one is damaged: nothing tells that it is missing
    assert_eq!((samples.len() as u64, counters.samples), (292, 292));
    assert_eq!((counters.bad_checksum, counters.lost, counters.gaps), (8, 8, 8));
    assert_eq!(counters.skipped_bytes, 6 * 22 + 11 + 9 + 25);
    assert_eq!(counters.device_errors, 2);
    let of = |number: u64| samples.iter().find(|sample| sample.sequence == Some(number)).unwrap().quality;
    assert_eq!((of(70), of(80)), (Quality::SATURATED, Quality::DEVICE_ERROR));
    drop(hold);
    let (end, served) = thread.join().unwrap();
    assert_eq!((end, served.lost, served.frames), (End::Source, 1, 301));
}

/// Unplugged and plugged in again: another pseudo-terminal behind the same path, as udev does it.
#[test]
fn unplugged_and_plugged_in_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sensor");
    // the test says when it has read what was sent, which would be gone with the pseudo-terminal
    let (read, all_read) = mpsc::channel::<()>();
    let device = {
        let path = path.clone();
        let mut pty = open_pty().unwrap();
        std::os::unix::fs::symlink(pty.path(), &path).unwrap();
        std::thread::spawn(move || {
            let source = (0..).map(|i| [f64::from(i); 6]);
            let script = Script::new().at(100, Fault::Disconnect);
            let device = FakeGsv8::new(6, 1000.0);
            let mut sensor = FakeSensor::new(device, source).with_script(script).with_room(usize::MAX);
            assert_eq!(sensor.serve(&mut pty, |_| true).unwrap(), End::Unplugged);
            all_read.recv().unwrap();
            drop(pty);
            std::fs::remove_file(&path).unwrap();
            std::thread::sleep(Duration::from_millis(200));
            let mut pty = open_pty().unwrap();
            std::os::unix::fs::symlink(pty.path(), &path).unwrap();
            let go_on = || all_read.try_recv() == Err(mpsc::TryRecvError::Empty);
            sensor.serve(&mut pty, |_| go_on()).unwrap()
        })
    };
    let reconnect = Reconnect::After { first: 0.02, most: 0.1 };
    let settings = LinkSettings { deadline: PATIENCE, reconnect, ..LinkSettings::default() };
    let mut link = link(path.to_str().unwrap(), Framed::new(Gsv), settings);
    let before = told(&mut link, 100);
    assert_eq!(before[99].channels[0], 99.0);
    read.send(()).unwrap();
    let error = link.next().unwrap().unwrap_err();
    assert!(matches!(error, LinkError::Broken(TransportError::SerialBroken { .. })), "{error}");
    let text = error.to_string();
    assert!(text.contains("/sensor broke: ") && text.ends_with("is the device still plugged in and on?"), "{text}");
    let after = told(&mut link, 100);
    assert_eq!(after[0].channels[0], 100.0);
    assert_eq!(after[0].quality, Quality::GAP_BEFORE | Quality::RESTARTED);
    assert!(after[1..].iter().all(|sample| sample.quality == Quality::empty()));
    assert_eq!((link.counters().reconnects, link.counters().samples), (1, 200));
    drop((link, read));
    device.join().unwrap();
}

/// A device that says nothing, nothing that means anything, or is gone, does not hold the program up.
#[test]
fn deadlines_hold() {
    let pty = open_pty().unwrap();
    let mut silent = link(pty.path(), Framed::new(Gsv), settings(0.2));
    let since = Instant::now();
    assert!(matches!(silent.next(), Some(Err(LinkError::Timeout { .. }))));
    let waited = since.elapsed().as_secs_f64();
    println!("silent: {waited:.3} s");
    assert!(waited >= 0.2);
    assert!(silent.counters().requests >= 1);

    let mut pty = open_pty().unwrap();
    let mut babble = link(pty.path(), Framed::new(Robotiq), settings(0.2));
    let (stop, stopped) = mpsc::channel::<()>();
    let thread = std::thread::spawn(move || {
        use std::io::Write;
        while stopped.try_recv() == Err(mpsc::TryRecvError::Empty) {
            let _ = pty.write(&[0x20, 0x4f, 0x09, 0x11]);
        }
        pty
    });
    let since = Instant::now();
    let end = babble.next();
    println!("babble: {:.3} s", since.elapsed().as_secs_f64());
    assert!(matches!(end, Some(Err(LinkError::Timeout { counters, .. })) if counters.skipped_bytes > 0));
    drop(stop);
    drop(thread.join().unwrap());

    // the device is gone, and does not come back
    assert!(matches!(babble.next(), Some(Err(LinkError::Broken(_)))));
    let since = Instant::now();
    assert!(matches!(babble.next(), Some(Err(LinkError::Timeout { .. }))));
    println!("gone: {:.3} s", since.elapsed().as_secs_f64());
    let error = SerialPort::open("/dev/none", 9600).unwrap_err().to_string();
    assert!(error.starts_with("cannot open the serial port /dev/none at 9600 baud: "), "{error}");
}
