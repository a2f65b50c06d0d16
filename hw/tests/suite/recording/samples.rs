//! Samples of tables: which column means what, in which unit, and what is refused; and recorded samples, which come back.

use proptest::prelude::*;
use rod_core::{Pose, Reactions};
use rod_hw::recording::{ColumnMap, Contents, Recorded, Recorder, Role, Table, TableOptions};
use rod_hw::{Channels, LinkCounters, OutOfPlane, Quality, RawSample, ReactionSample, Wrench, WrenchSample};

fn parse(text: &str) -> Table {
    Table::parse("f.csv", text.as_bytes(), &TableOptions::default()).unwrap()
}

fn samples<S: Recorded>(text: &str, map: &ColumnMap) -> Vec<S> {
    parse(text).samples(map).unwrap().map(Result::unwrap).collect()
}

fn refuses<S: Recorded + std::fmt::Debug>(text: &str, map: &ColumnMap, parts: &[&str]) {
    let table = parse(text);
    let message = table.samples::<S>(map).err().unwrap().to_string();
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
    assert_eq!(message.lines().count(), 1, "{message}");
}

#[test]
fn wrenches_in_their_units() {
    for text in [
        "t,Fx [N],Fy [N],Fz [N],Tx [N mm],Ty [N mm],Tz [N mm]\n0.5,1,2,3,4000,5000,6000\n",
        "Time (ms);Fx (mN);Fy (mN);Fz (mN);Mx (Nm);My (Nm);Mz (Nm)\n500;1000;2000;3000;4;5;6\n",
        "time_ms\tFx_N\tFy_N\tFz_N\tTx_Nm\tTy_Nm\tTz_Nm\n500\t1\t2\t3\t4\t5\t6\n",
        "t fx fy fz tx ty tz\n0.5 1 2 3 4 5 6\n",
    ] {
        let found: Vec<WrenchSample> = samples(text, &ColumnMap::new());
        let expected = WrenchSample::new(0.5, Wrench::from_components([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(found, [expected], "{text}");
    }
    // three forces and one moment: what is not measured must be said
    let text = "t,fx,fy,fz,Mz [mN m]\n0,1,2,3,4\n";
    refuses::<WrenchSample>(text, &ColumnMap::new(), &["f.csv:1: no column tx, ty, found t, fx, fy, fz, Mz [mN m]"]);
}

#[test]
fn units_that_are_missing_or_wrong() {
    let new = ColumnMap::new();
    let header = |fx: &str| format!("t,{fx},fy,fz,tx,ty,tz\n0,1,2,3,4,5,6\n");
    refuses::<WrenchSample>(
        &header("Fx"),
        &new,
        &[
            "f.csv:1: no unit of Fx, expected one of force, as in `Fx [N]`; write it there, or give it in the options; only a column named fx needs no unit, it is in N",
        ],
    );
    refuses::<WrenchSample>(
        &header("Fx [V]"),
        &new,
        &["f.csv:1: the unit of Fx [V]: `V` is not a known unit, expected one of force: N, mN"],
    );
    refuses::<WrenchSample>(&header("fx [N m]"), &new, &["`N m` is a unit of torque, expected one of force"]);
    refuses::<WrenchSample>(
        &header("fx,Fx [N]").replace("0,1", "0,1,1"),
        &new.clone().with(Role::Fx, "F"),
        &["no column `F`, found t, fx, Fx [N]"],
    );
    // a time that is only welcome, without a unit, is left out and not guessed
    let text = "time,host_time,channel1\n0,5,1\n";
    let found: Vec<RawSample> = samples(text, &new);
    assert_eq!(found[0].host_time, 5.0);
    let table = parse(text);
    let columns = new.find(&table, &[], &[Role::Time, Role::HostTime]).unwrap();
    assert_eq!(columns.ignored(&table).collect::<Vec<_>>(), ["time"]);
    let options = TableOptions { units: vec![("Fx".into(), "mN".into())], ..TableOptions::default() };
    let table = Table::parse("f.csv", header("Fx").as_bytes(), &options).unwrap();
    assert_eq!(table.samples::<WrenchSample>(&new).unwrap().next().unwrap().unwrap().wrench.force[0], 1e-3);
}

#[test]
fn columns_by_name() {
    let new = ColumnMap::new();
    let header = "t,fx,fy,fz,tx,ty,tz";
    refuses::<WrenchSample>(
        &format!("{header},tz\n0,1,2,3,4,5,6,7\n"),
        &new,
        &["f.csv:1: two columns are named tz, expected one; say which"],
    );
    refuses::<WrenchSample>(
        "t,fx,fy,fz,tx,ty,Tz [N m],Mz [N m]\n0,1,2,3,4,5,6,7\n",
        &new,
        &["two columns are named Tz [N m] and Mz [N m], which mean the same, expected one"],
    );
    let map = new.clone().with(Role::Tz, "Mz");
    let found: Vec<WrenchSample> = samples("t,fx,fy,fz,tx,ty,Tz [N m],Mz [N m]\n0,1,2,3,4,5,6,7\n", &map);
    assert_eq!(found[0].wrench.torque[2], 7.0);
    refuses::<ReactionSample>(
        "t,x0,y0,PHI0,f0x-mean,f0y,m0z\n0,1,2,3,4,5,6\n",
        &new,
        &[
            "no column phi0, f0x, found",
            "; `PHI0` is phi0 but for its letters' case",
            "; is `f0x-mean` f0x? Give it in N and name it f0x",
        ],
    );
    refuses::<RawSample>("channel1\n1\n", &new, &["no column t, found channel1"]);
    refuses::<RawSample>(
        "t,a\n0,1\n",
        &new,
        &["no channels, found t, a; name them in the column map, expected 1 to 16 columns"],
    );
    let many: Vec<String> = (0..17).map(|i| format!("ch{i}")).collect();
    refuses::<RawSample>(&format!("t,{}\n", many.join(",")), &new, &["17 channels, expected at most 16"]);
    let found: Vec<RawSample> = samples("t,ch2,SG 1,chair\n0,1,2,3\n", &new);
    assert_eq!(&found[0].channels[..], [1.0, 2.0]);
}

/// Takes what any source gives.
fn drain<E>(source: impl Iterator<Item = Result<RawSample, E>>) -> (Vec<f64>, usize) {
    let mut faults = 0;
    let times = source.filter_map(|sample| sample.map_err(|_| faults += 1).ok().map(|sample| sample.time())).collect();
    (times, faults)
}

#[test]
fn faults_and_times_that_do_not_grow() {
    let text = "t,sequence,status,quality,channel1\n0,1,0,good,1\n1,2,-1,good,1\n2,3.5,0,good,1\n3,3,0,odd,1\n\
        4,4,0x80000001,saturated|gap before,1\n4,5,0,\"spike, gap before\",1\n3.5,6,0,,1\n5,7,0,7,1\n6,8,,,1\n7,9,0,good,\n";
    let table = parse(text);
    let faults: Vec<String> =
        table.samples::<RawSample>(&ColumnMap::new()).unwrap().filter_map(Result::err).map(|f| f.to_string()).collect();
    assert_eq!(
        faults,
        [
            "line 3: status is -1, expected a whole number from 0 to 4294967295",
            "line 4: sequence is 3.5, expected a whole number from 0 to 9007199254740992",
            "line 5: quality is `odd`, expected good, or flags by their names, with | between them",
            "line 7: the time 4 s is not later than 4 s of line 6, expected a later time",
            "line 8: the time 3.5 s is not later than 4 s of line 6, expected a later time",
            "line 9: quality is `7`, expected good, or flags by their names, with | between them",
            "line 11: channel1 is empty, expected a number",
        ]
    );
    let read = || table.samples::<RawSample>(&ColumnMap::new()).unwrap();
    assert_eq!(drain(read()), (vec![0.0, 4.0, 6.0], 7));
    let second = read().flatten().nth(1).unwrap();
    assert_eq!((second.status, second.quality), (0x8000_0001, Quality::SATURATED | Quality::GAP_BEFORE));
    let text = "t,x0,y0,phi0,f0x,f0y,m0z,sigma_f0x,sigma_f0y,sigma_m0z\n0,1,2,3,4,5,6,1,,1\n1,1,2,3,4,5,6,1,-1,1\n2,1,2,3,4,5,6,,,\n";
    let table = parse(text);
    let read: Vec<_> = table.samples::<ReactionSample>(&ColumnMap::new()).unwrap().collect();
    assert_eq!(read[0].as_ref().unwrap_err().to_string(), "line 2: sigma_f0y is empty, expected a number");
    assert_eq!(
        read[1].as_ref().unwrap_err().to_string(),
        "line 3: sigma_f0y is -1, expected a number that is not negative"
    );
    assert!(read[2].as_ref().unwrap().sigma.is_none());
}

/// Any finite number, those with all exponents and both zeros.
fn finite() -> impl Strategy<Value = f64> {
    any::<f64>().prop_filter("finite", |value| value.is_finite())
}

fn raw(channels: usize) -> impl Strategy<Value = RawSample> {
    let known = (proptest::option::of(0..1_u64 << 53), proptest::option::of(finite()), finite(), any::<u32>());
    let rest = (proptest::option::of(finite()), proptest::collection::vec(finite(), channels), 0_u16..1 << 9);
    (known, rest).prop_map(|((sequence, device_time, host_time, status), (temperature, channels, bits))| RawSample {
        sequence,
        device_time,
        host_time,
        status,
        temperature,
        channels: Channels::new(&channels).unwrap(),
        quality: Quality::from_bits_truncate(bits),
    })
}

fn reactions() -> impl Strategy<Value = Reactions> {
    proptest::array::uniform3(finite()).prop_map(|[f0x, f0y, m0z]| Reactions { f0x, f0y, m0z })
}

/// Writes the samples and reads them again.
fn there_and_back(all: &[ReactionSample], contents: Contents) -> Vec<ReactionSample> {
    let notes = [("sensor", "any: one, \"quoted\""), ("run", "3"), ("tare", "")];
    let mut recorder = Recorder::new(Vec::new(), &notes, contents).unwrap();
    for sample in all {
        recorder.write(sample).unwrap();
    }
    let file = recorder.finish(Some(&LinkCounters { samples: 7, lost: 2, ..LinkCounters::default() })).unwrap();
    let table = Table::parse("f.csv", &file, &TableOptions::default()).unwrap();
    assert_eq!((table.note("sensor"), table.note("run")), (Some("any: one, \"quoted\""), Some("3")));
    assert_eq!(table.is_whole(), Some(true));
    assert_eq!(table.note("link"), Some("7 samples, 2 lost"));
    let cut = Table::parse("f.csv", &file[..file.len() - 9], &TableOptions::default()).unwrap();
    assert_eq!(cut.is_whole(), Some(false));
    table.samples(&ColumnMap::new()).unwrap().map(Result::unwrap).collect()
}

/// Debug tells -0 from 0, and has the digits that make numbers the same bit by bit.
fn same<S: std::fmt::Debug>(a: &[S], b: &[S]) {
    assert_eq!(format!("{a:?}"), format!("{b:?}"));
}

const ALL: Contents = Contents { raw: Some(3), sigma: true, systematic: true, out_of_plane: true };

proptest! {
    #[test]
    fn reactions_come_back(
        all in proptest::collection::vec((finite(), proptest::array::uniform6(finite()), reactions(), proptest::option::of(reactions()), raw(3), 0_u16..1 << 9), 1..8),
    ) {
        let mut all: Vec<ReactionSample> = all
            .into_iter()
            .map(|(t, [x, y, phi, f0z, m0x, m0y], reactions, sigma, raw, bits)| ReactionSample {
                t,
                pose: Pose { x, y, phi },
                reactions,
                sigma: sigma.map(|s| Reactions { f0x: s.f0x.abs(), f0y: s.f0y.abs(), m0z: s.m0z.abs() }),
                systematic: None,
                out_of_plane: OutOfPlane { f0z, m0x, m0y },
                quality: Quality::from_bits_truncate(bits),
                raw,
            })
            .collect();
        // times that grow, as a recording has them
        all.sort_by(|a, b| a.t.total_cmp(&b.t));
        all.dedup_by(|a, b| a.t == b.t);
        same(&there_and_back(&all, ALL), &all);
    }
}

#[test]
fn what_is_not_in_the_contents_is_left_out() {
    let sample = ReactionSample {
        t: 0.25,
        pose: Pose { x: 1.0, y: 2.0, phi: 3.0 },
        reactions: Reactions { f0x: 4.0, f0y: 5.0, m0z: 6.0 },
        sigma: None,
        systematic: None,
        out_of_plane: OutOfPlane::default(),
        quality: Quality::empty(),
        raw: RawSample::new(0.25, Channels::default()),
    };
    assert_eq!(there_and_back(&[sample], Contents::default()), [sample]);
    let with_sigma = ReactionSample { sigma: Some(sample.reactions), ..sample };
    assert_eq!(there_and_back(&[with_sigma], Contents::default()), [sample]);
    let contents = Contents { raw: Some(2), ..Contents::default() };
    let mut recorder = Recorder::new(Vec::new(), &[], contents).unwrap();
    let one = ReactionSample { raw: RawSample::new(0.0, Channels::from([1.0])), ..sample };
    let message = recorder.write(&one).unwrap_err().to_string();
    assert_eq!(message, "the sample has 1 channels, expected 2 as in the contents of the recording");
    let empty = recorder.finish(None).unwrap();
    let expected = "# vibrissa recording 1\n\
        # units: t s, x0 m, y0 m, phi0 rad, f0x N, f0y N, m0z N m, host_time s, device_time s, temperature degC\n\
        t,x0,y0,phi0,f0x,f0y,m0z,quality,host_time,device_time,sequence,status,temperature,raw_quality,channel1,channel2\n\
        # flagged: 0\n# end of the recording, samples: 0\n";
    assert_eq!(String::from_utf8(empty).unwrap(), expected);
}
