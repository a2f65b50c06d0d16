//! A sensor that is none, playing what it would feel along a scene.

mod pty;

use pty::play_pty;
use rod_fake_sensor::{FakeBota, FakeGsv8, FakeRdt, FakeRdtSettings};
use rod_files::{SensorCalibration, Setup, Simulation, SimulationError, Tick};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;
use vibrissa::contact::Stop;
use vibrissa::hw::device::rdt::{RdtRecord, RdtScaling};
use vibrissa::hw::{Dimension, OutOfPlane, Scale, Unit};
use vibrissa::rod::Reactions;

/// Samples that are made in advance, before the first is played and while it plays.
const AHEAD: usize = 4096;
/// How often to look whether it is over.
const LOOK: Duration = Duration::from_millis(20);

/// What the sensor speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum FakeProtocol {
    /// RDT over UDP, as ATI Net F/T sensors do, with the scaling over TCP
    Rdt,
    /// ME-Messsysteme GSV-8 on a pseudo-terminal, floats in N and N m
    Gsv8,
    /// Bota Systems on a pseudo-terminal
    Bota,
}

/// A sensor to be played.
#[derive(Debug)]
pub struct FakeScan {
    /// What it feels, and at which rate it is asked. The clamp is rigid: on springs the base would move against the sensor.
    pub simulation: Simulation,
    /// How it is mounted, and what its counts are.
    pub setup: Setup,
    /// What it speaks.
    pub protocol: FakeProtocol,
    /// How much faster than real time it plays.
    pub faster: f64,
    /// UDP port of the samples, 0 for any.
    pub port: u16,
    /// TCP port of the scaling, 0 for any.
    pub scaling_port: u16,
}

/// What was played.
#[derive(Clone, Debug, PartialEq)]
pub struct Played {
    /// Samples made.
    pub samples: u64,
    /// Samples sent.
    pub sent: u64,
    /// Why the sweep stopped before the end of the path, if it did.
    pub stop: Option<Stop>,
}

/// Why a sensor cannot be played.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FakeError {
    /// Its address cannot be had, or its connection broke.
    #[error(
        "cannot play the sensor at {place}: {source}; is another one running there? --port takes another port, 0 any"
    )]
    Place {
        /// Where.
        place: String,
        /// Why.
        source: std::io::Error,
    },
    /// A serial line, on a system without pseudo-terminals.
    #[error("{protocol} needs a pseudo-terminal, which only Unix systems have; use --protocol rdt here")]
    NoPty {
        /// What was to be played.
        protocol: &'static str,
    },
    /// There is no way back from a wrench to the gauges.
    #[error(
        "the setup has a calibration from gauges to a wrench, which has no inverse; expected units, or counts, in the table \
         [sensor]"
    )]
    Gauges,
    /// A pace that is none.
    #[error("--faster is {value}, expected a positive, finite number of times real time")]
    Pace {
        /// Its value.
        value: f64,
    },
    /// The scene cannot be recorded.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

/// One million counts a unit, as ATI's devices are delivered.
const COUNTS: f64 = 1e6;

impl FakeScan {
    /// Makes the first 4096 samples, then plays until all samples are sent or `stopped` says so; a sensor that waits to be started waits. `tell` is handed lines to
    /// show, the first of them the address.
    ///
    /// Poses that a snap jumps over are filled with what was felt before, for a sensor has no gaps.
    ///
    /// # Errors
    /// [`FakeError`].
    pub fn run(self, tell: &mut dyn FnMut(&str), stopped: &dyn Fn() -> bool) -> Result<Played, FakeError> {
        if !(self.faster.is_finite() && self.faster > 0.0) {
            return Err(FakeError::Pace { value: self.faster });
        }
        // mistakes are told before anything is played
        self.simulation.ticks()?;
        let rate = self.simulation.rate;
        let pace = rate * self.faster;
        let Self { simulation, setup, protocol, port, scaling_port, .. } = self;
        let name = simulation.scene.name.clone();
        let playing = format!("{name}, {rate} samples per second of the scene, {pace} per second of real time");
        let scaling = RdtScaling {
            force_unit: unit("N", Dimension::Force, 1.0),
            torque_unit: unit("N mm", Dimension::Torque, 1e-3),
            counts_per_force: COUNTS,
            counts_per_torque: COUNTS,
        };
        let told = match &setup.calibration {
            None => None,
            Some(SensorCalibration::Scale(scale)) => Some(*scale),
            Some(SensorCalibration::Gauges(_)) => return Err(FakeError::Gauges),
        };
        let scale = match (protocol, told) {
            (_, Some(scale)) => scale,
            (FakeProtocol::Rdt, None) => scaling.calibration().unwrap_or_else(|_| Scale::si()),
            (FakeProtocol::Gsv8 | FakeProtocol::Bota, None) => Scale::si(),
        };
        let (sender, receiver) = sync_channel(AHEAD);
        let (begun, enough) = sync_channel(0);
        let maker = thread::spawn(move || make(&simulation, &setup, scale, &sender, begun));
        // what computes while it plays falls silent on a busy machine
        while enough.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) && !stopped() {}
        let sent = match protocol {
            FakeProtocol::Rdt => {
                let address = |port| SocketAddr::from((Ipv4Addr::LOCALHOST, port));
                let settings = FakeRdtSettings {
                    address: address(port),
                    // counts that the setup tells are not those of the record
                    scaling_address: told.is_none().then(|| address(scaling_port)),
                    rate: Some(pace),
                    scaling,
                    ..FakeRdtSettings::default()
                };
                play_rdt(settings, receiver, &playing, tell, stopped)
            }
            FakeProtocol::Gsv8 => play_pty(FakeGsv8::new(6, rate), "gsv8", pace, receiver, &playing, tell, stopped),
            FakeProtocol::Bota => play_pty(FakeBota::new(rate), "bota", pace, receiver, &playing, tell, stopped),
        }?;
        // ended early, the maker finds nobody who listens
        let (samples, stop) = maker.join().unwrap_or((sent, None));
        Ok(Played { samples, sent, stop })
    }
}

fn unit(name: &'static str, dimension: Dimension, factor: f64) -> Unit {
    Unit { name, dimension, factor }
}

/// Makes the channels of all samples, in order, and closes `begun` once [`AHEAD`] or all are made. How many, and why no more.
fn make(
    simulation: &Simulation,
    setup: &Setup,
    scale: Scale,
    sender: &SyncSender<[f64; 6]>,
    begun: SyncSender<()>,
) -> (u64, Option<Stop>) {
    let mut begun = Some(begun);
    let (mut made, mut felt) = (0, Reactions::default());
    // checked before
    let Ok(ticks) = simulation.ticks() else { return (0, None) };
    for tick in ticks {
        match tick {
            Ok(Tick { number, pose, reactions, .. }) => {
                let now = reactions.unwrap_or(felt);
                for reactions in std::iter::repeat_n(felt, (number as u64).saturating_sub(made) as usize).chain([now]) {
                    let wrench = setup.mounting.wrench(&reactions, &OutOfPlane::default(), pose);
                    let channels = scale.channels(&wrench);
                    if made == AHEAD as u64 {
                        drop(begun.take());
                    }
                    if sender.send(std::array::from_fn(|i| channels.get(i).copied().unwrap_or_default())).is_err() {
                        return (made, None);
                    }
                    made += 1;
                }
                felt = now;
            }
            Err(stop) => return (made, Some(stop)),
        }
    }
    (made, None)
}

fn play_rdt(
    settings: FakeRdtSettings,
    samples: Receiver<[f64; 6]>,
    playing: &str,
    tell: &mut dyn FnMut(&str),
    stopped: &dyn Fn() -> bool,
) -> Result<u64, FakeError> {
    let place = settings.address.to_string();
    let records = samples.into_iter().map(|channels| {
        // a conversion to whole numbers that saturates, as a device does
        RdtRecord { packet: 0, sample: 0, status: 0, counts: channels.map(|value| value.round() as i32) }
    });
    let fake = FakeRdt::start(settings, records).map_err(|source| FakeError::Place { place, source })?;
    let scaling = fake.scaling_address().map(|address| format!("?scaling={}", address.port())).unwrap_or_default();
    tell(&format!("rdt://{}{scaling}: {playing}; waits for a client", fake.address()));
    while !fake.ended() && !stopped() {
        thread::sleep(LOOK);
    }
    Ok(fake.account().records)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_files::Scene;
    use vibrissa::reconstruct::NoiseModel;

    /// A rod that tapers is felt as `simulate` says.
    #[test]
    fn a_cone_is_played() {
        let scene = "[rod]\nlength = 0.1\ndiameter = 0.5e-3\ntip_diameter = 0.2e-3\nyoungs_modulus = 206e9\n\
                     [[contour.piece]]\nshape = \"parabola\"\nvertex = [0.0, 0.0]\ncoefficient = 50.0\n\
                     [sweep]\nfrom = [0.06, -0.04]\nto = [0.03, -0.04]\nangle = 90.0\nstep = 1e-3\n";
        let scene = Scene::parse("scene.toml".as_ref(), scene).unwrap();
        assert!(scene.rod.uniform().is_none());
        let simulation =
            Simulation { scene, noise: NoiseModel::default(), rate: 100.0, speed: 0.01, seed: 0, sigmas: false };
        let felt: Vec<Reactions> = simulation.ticks().unwrap().map(|tick| tick.unwrap().reactions.unwrap()).collect();
        assert!(felt.iter().any(|reactions| reactions.m0z.abs() > 1e-5));
        let (sender, receiver) = sync_channel(AHEAD);
        let (begun, enough) = sync_channel(0);
        let maker = thread::spawn(move || make(&simulation, &Setup::default(), Scale::si(), &sender, begun));
        let played: Vec<[f64; 6]> = receiver.into_iter().collect();
        assert_eq!(maker.join().unwrap(), (felt.len() as u64, None));
        assert!(enough.recv().is_err(), "what is made in advance is at hand");
        // Fx, Fy and Tz of a sensor whose axes are those of the scene, and which feels what acts on it
        for (channels, Reactions { f0x, f0y, m0z }) in played.iter().zip(&felt) {
            let off = [channels[0] + f0x, channels[1] + f0y, channels[5] + m0z];
            assert!(off.iter().all(|off| off.abs() < 1e-15), "{channels:?} {f0x} {f0y} {m0z}");
        }
        assert_eq!(played.len(), felt.len());
    }
}
