use crate::envelope::touches;
use crate::fit::{Fit, Noise};
use crate::known::Clamp;
use crate::single::MomentZero;
use crate::track::Track;
use nalgebra::{Matrix3, Vector3};
use rod_contact::{ClampPath, Item, State, Sweep};
use rod_contours::{Composite, Parabola};
use rod_core::{Pose, Rod, Units};

pub fn scan(object: usize, q: f64, step: f64) -> (Vec<State>, Vec<(f64, String)>, Composite) {
    let v = [[[0.0, 0.0], [0.3, 0.0]], [[0.0, 0.0], [0.3, 0.1]], [[0.0, 0.1], [0.3, 0.0]]][object];
    let pieces: Vec<Box<dyn rod_contours::Contour>> =
        v.iter().map(|&v| Box::new(Parabola::new(v, 5.0).unwrap()) as Box<dyn rod_contours::Contour>).collect();
    let object = Composite::joined(pieces).unwrap();
    let rod = Rod::new(1.0, 1.0).unwrap();
    let clamp = |x| Pose { x, y: -q, phi: std::f64::consts::FRAC_PI_2 };
    let path = ClampPath::new(clamp(0.8), clamp(-0.9)).unwrap();
    let mut states = Vec::new();
    let mut events = Vec::new();
    for item in Sweep::new(&rod, &object, path, step).unwrap() {
        match item {
            Ok(Item::State(s)) => states.push(s),
            Ok(Item::Event(e)) => events.push((0.8 - e.pose().x, format!("{} {}->{}", e.kind, e.from(), e.to()))),
            _ => {}
        }
    }
    (states, events, object)
}

#[test]
#[ignore]
fn explore() {
    let o: usize = std::env::var("O").unwrap_or("0".into()).parse().unwrap();
    let q: f64 = std::env::var("Q").unwrap_or("0.4".into()).parse().unwrap();
    let sigma: f64 = std::env::var("SIGMA").unwrap_or("0".into()).parse().unwrap();
    let (states, events, object) = scan(o, q, 2e-5);
    println!("{} states", states.len());
    for (t, e) in &events {
        println!("{t:.6} {e}");
    }
    let mut seed = 1u64;
    let mut gauss = || {
        let mut s = 0.0;
        for _ in 0..12 {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            s += (seed >> 11) as f64 / (1u64 << 53) as f64;
        }
        s - 6.0
    };
    let mut track = Track::default();
    for s in &states {
        track.tau.push(0.8 - s.pose.x);
        let mut c = Clamp::new(Units::ONE, s.pose, s.reactions);
        c.reactions += Vector3::new(gauss() * 0.04, gauss() * 0.04, gauss() * 0.0095) * sigma;
        track.clamps.push(c);
    }
    let var = (Vector3::new(0.04, 0.04, 0.0095) * sigma).map(|v| (v * v).max(1e-26));
    let noise = Noise { variance: var, long_run: Vector3::repeat(1.0) };
    let mut start = 0;
    while start < states.len() {
        let phase = states[start].phase().to_string();
        let mut end = start;
        while end < states.len()
            && states[end].phase().to_string() == phase
            && !events.iter().any(|(t, _)| end > start && track.tau[end - 1] < *t && *t <= track.tau[end])
        {
            end += 1;
        }
        println!("--- {phase} {:.5}..{:.5} {} samples", track.tau[start], track.tau[end - 1], end - start);
        if phase != "free" {
            for k in 0..=12 {
                let i = start + (end - 1 - start) * k / 12;
                let t0 = std::time::Instant::now();
                let Some(fit) = Fit::about(&track, i, start..end, &noise, 1500) else {
                    println!("no fit");
                    continue;
                };
                let e = fit.at(track.tau[i]);
                let el = t0.elapsed();
                let st = &states[i];
                let mz = MomentZero::of(&e.clamp, &Matrix3::zeros());
                let truth: Vec<String> = st.contacts.iter().map(|c| format!("{:.4}", c.s)).collect();
                print!("{:.5} w{} {:?} true {:?} ", track.tau[i], fit.window.len(), el, truth);
                if let Ok(m) = &mz {
                    print!("sc {:.5} ", m.s);
                    let sp = crate::envelope::NormalSpeed::at(&e, m.s);
                    print!(
                        "vn {:.1e}+-{:.1e} K {:.1e} ",
                        sp.value,
                        e.variance(&Vector3::zeros(), &sp.by_rate).sqrt(),
                        e.clamp.criterion().0
                    );
                }
                if st.contacts.len() > 1 {
                    touches(&e, 1.0, |s, sp| {
                        let c = &st.contacts[0];
                        let d = (sp.section.x - c.x).hypot(sp.section.y - c.y);
                        let sd = e.variance(&Vector3::zeros(), &sp.by_rate).sqrt() / sp.by_s.abs();
                        print!(" | s {s:.5} off {d:.1e} sd {sd:.1e} v' {:.2}", sp.by_s);
                    });
                }
                println!();
            }
        }
        if phase == "BA" || phase == "BB" {
            let stride: usize = std::env::var("STRIDE").unwrap_or("1".into()).parse().unwrap();
            let nodes: Vec<usize> = (start..end).step_by(stride).chain([end - 1]).collect();
            let fits: Vec<_> = nodes
                .iter()
                .map(|&i| Fit::about(&track, i, start..end, &noise, 1500).unwrap().at(track.tau[i]))
                .collect();
            let s1: Vec<f64> = nodes
                .iter()
                .zip(&fits)
                .map(|(&i, e)| {
                    let mut best: Option<(f64, f64)> = None;
                    touches(e, 1.0, |s, _| {
                        let d = (s - states[i].contacts[0].s).abs();
                        if best.is_none_or(|b| d < b.1) {
                            best = Some((s, d))
                        }
                    });
                    best.filter(|b| b.1 < 0.1).map_or(f64::NAN, |b| b.0)
                })
                .collect();
            let beyond: Vec<_> = fits.iter().zip(&s1).map(|(e, &s)| crate::beyond::Beyond::new(&e.clamp, s)).collect();
            let n = nodes.len();
            let mut f = vec![f64::NAN; n];
            if phase == "BA" {
                let mut g = states[start].contacts[0].force;
                for k in 0..n {
                    if let Some(h) = beyond[k].force_of_tip(g) {
                        g = h;
                        f[k] = h;
                    }
                }
            } else {
                // anchors: neighbours' last contact at both sides
                let neighbour = |i: usize, range: std::ops::Range<usize>| -> Option<(f64, f64, f64, f64)> {
                    let st = &states[i];
                    let e = Fit::about(&track, i, range.clone(), &noise, 1500)?.at(track.tau[i]);
                    match st.phase().to_string().as_str() {
                        "B" => {
                            let m = MomentZero::of(&e.clamp, &Matrix3::zeros()).ok()?;
                            Some((m.s, m.section.x, m.section.y, m.section.phi))
                        }
                        "BA" => {
                            let mut best = None;
                            touches(&e, 1.0, |s, _| {
                                if (s - st.contacts[0].s).abs() < 0.05 {
                                    best = Some(s)
                                }
                            });
                            let b = crate::beyond::Beyond::new(&e.clamp, best?);
                            let f = b.force_of_tip(st.contacts[0].force)?;
                            let t = b.tip(f).0;
                            println!("BA neighbour f {f} true {}", st.contacts[0].force);
                            Some((1.0, t.x, t.y, t.phi))
                        }
                        _ => None,
                    }
                };
                let before = {
                    let mut a = start - 1;
                    while a > 0 && states[a - 1].phase() == states[start - 1].phase() {
                        a -= 1
                    }
                    neighbour(start - 1, a..start)
                };
                let after = {
                    let mut b = end;
                    while b < states.len() && states[b].phase() == states[end].phase() {
                        b += 1
                    }
                    neighbour(end, end..b)
                };
                let march = |anchor: (f64, f64, f64, f64), order: Vec<usize>, guess: f64| -> Vec<f64> {
                    let mut out = vec![f64::NAN; n];
                    let mut f = guess;
                    let mut l = anchor;
                    for k in order {
                        let g = |f: f64| -> Option<(f64, (f64, f64, f64, f64))> {
                            let nn = beyond[k].second(f)?.section;
                            let phi = 0.5 * (l.3 + nn.phi);
                            Some((-(nn.x - l.1) * phi.sin() + (nn.y - l.2) * phi.cos(), (0.0, nn.x, nn.y, nn.phi)))
                        };
                        let h = 1e-6;
                        for _ in 0..12 {
                            let (Some(a), Some(b)) = (g(f), g(f + h)) else { return out };
                            let step = a.0 / ((b.0 - a.0) / h);
                            f -= step.clamp(-0.3, 0.3);
                            if step.abs() < 1e-12 {
                                break;
                            }
                        }
                        let Some(x) = g(f) else { return out };
                        l = x.1;
                        out[k] = f;
                    }
                    out
                };
                let fs = states[start].contacts[0].force;
                let fe = states[end - 1].contacts[0].force;
                let near = |a: Option<(f64, f64, f64, f64)>, s: f64| a.filter(|a| (a.0 - s).abs() > 0.02);
                let fw = near(before, s1[0]).map(|a| march(a, (0..n).collect(), fs));
                let bw = near(after, s1[n - 1]).map(|a| march(a, (0..n).rev().collect(), fe));
                println!("anchors {:?} {:?}", fw.is_some(), bw.is_some());
                for (name, v) in [("fw", &fw), ("bw", &bw)] {
                    if let Some(v) = v {
                        let mut e: Vec<f64> =
                            v.iter().zip(&nodes).map(|(f, &i)| (f - states[i].contacts[0].force).abs()).collect();
                        println!("{name} start {:.1e} mid {:.1e} end {:.1e}", e[0], e[n / 2], e[n - 1]);
                        e.clear();
                    }
                }
                for k in 0..n {
                    let w = k as f64 / (n - 1) as f64;
                    f[k] = match (&fw, &bw) {
                        (Some(u), Some(v)) if v[k].is_finite() => (1.0 - w) * u[k] + w * v[k],
                        (Some(u), _) => u[k],
                        (None, Some(v)) => v[k],
                        _ => f64::NAN,
                    };
                }
            }
            let (mut e1, mut e2, mut ef): (Vec<f64>, Vec<f64>, Vec<f64>) = (vec![], vec![], vec![]);
            let (mut c1, mut c2): (Vec<f64>, Vec<f64>) = (vec![], vec![]);
            use rod_contours::Contour;
            let mut lost = 0;
            for k in 0..n {
                let st = &states[nodes[k]];
                if st.contacts[1].force < 0.1 {
                    continue;
                }
                let second = if phase == "BA" {
                    f[k].is_finite().then(|| beyond[k].tip(f[k]).0)
                } else {
                    beyond[k].second(f[k]).map(|s| s.section)
                };
                let Some(sec) = second else {
                    lost += 1;
                    continue;
                };
                c1.push(object.closest(beyond[k].first.x, beyond[k].first.y).gap.abs());
                c2.push(object.closest(sec.x, sec.y).gap.abs());
                e1.push((beyond[k].first.x - st.contacts[0].x).hypot(beyond[k].first.y - st.contacts[0].y));
                e2.push((sec.x - st.contacts[1].x).hypot(sec.y - st.contacts[1].y));
                ef.push((f[k] - st.contacts[0].force).abs());
            }
            let mut q = |v: &mut Vec<f64>| {
                v.sort_by(f64::total_cmp);
                let n = v.len();
                if n == 0 {
                    return String::new();
                }
                format!("med {:.1e} 95 {:.1e} max {:.1e}", v[n / 2], v[n * 95 / 100], v[n - 1])
            };
            println!("== {phase} n {} lost {lost} d1 {} | d2 {} | f {}", e1.len(), q(&mut e1), q(&mut e2), q(&mut ef));
            println!("   contour: d1 {} | d2 {}", q(&mut c1), q(&mut c2));
        }
        start = end;
    }
}

#[test]
#[ignore]
fn identification() {
    let sigma: f64 = std::env::var("SIGMA").unwrap_or("0".into()).parse().unwrap();
    let rho: f64 = std::env::var("RHO").unwrap_or("0".into()).parse().unwrap();
    for o in 0..3 {
        for q in [0.2, 0.4, 0.6] {
            let (states, events, _) = scan(o, q, 2e-5);
            let mut seed = 1u64;
            let mut gauss = || {
                let mut s = 0.0;
                for _ in 0..12 {
                    seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                    s += (seed >> 11) as f64 / (1u64 << 53) as f64;
                }
                s - 6.0
            };
            let mut track = Track::default();
            let mut ar = Vector3::zeros();
            for s in &states {
                track.tau.push(0.8 - s.pose.x);
                let mut c = Clamp::new(Units::ONE, s.pose, s.reactions);
                ar = ar * rho
                    + Vector3::new(gauss() * 0.04, gauss() * 0.04, gauss() * 0.0095) * (1.0 - rho * rho).sqrt();
                c.reactions += ar * sigma;
                track.clamps.push(c);
            }
            let var = (Vector3::new(0.04, 0.04, 0.0095) * sigma).map(|v| (v * v).max(1e-26));
            let noise = Noise { variance: var, long_run: Vector3::repeat((1.0 + rho) / (1.0 - rho)) };
            let mut breaks: Vec<crate::phases::Break> = events
                .iter()
                .filter(|e| !e.1.contains("A->B") || e.1.contains("BA"))
                .map(|(t, e)| crate::phases::Break {
                    index: track.tau.partition_point(|u| u < t),
                    jump: e.contains("snap"),
                    score: 100.0,
                })
                .collect();
            for k in 0..5 {
                breaks.push(crate::phases::Break {
                    index: (9000 + 17001 * k) % states.len(),
                    jump: false,
                    score: 30.0,
                });
            }
            breaks.sort_by_key(|b| b.index);
            let t0 = std::time::Instant::now();
            let found = crate::phases::identify(&track, &noise, &breaks);
            let el = t0.elapsed();
            let mut wrong = 0;
            let mut multi = 0;
            for (range, label) in &found.runs {
                for i in range.clone() {
                    let p = states[i].phase();
                    let truth = crate::Label::of(p.contacts, p.tip);
                    if truth != *label {
                        wrong += 1;
                        if truth.several() != label.several() {
                            multi += 1
                        }
                    }
                }
            }
            if std::env::var("SHOW").is_ok() {
                for (n, l) in found.nodes.iter().zip(&found.labels) {
                    println!(
                        "N {:.4} w{} K z {:.1} s z {:.1} T {:.1e} z {:.1} | {} {:.2} {:?}",
                        track.tau[n.index],
                        n.fit.window.len(),
                        n.evidence.criterion.z(),
                        n.evidence.length.z(),
                        n.evidence.tangent.value,
                        n.evidence.tangent.z(),
                        l.0,
                        l.1,
                        n.place.scores.map(|v| (v * 10.0).round() / 10.0)
                    );
                }
            }
            println!(
                "O{o} q{q} wrong {wrong} ({:.3} %) several {multi} nodes {} in {el:?}: {}",
                100.0 * wrong as f64 / states.len() as f64,
                found.nodes.len(),
                found.runs.iter().map(|(r, l)| format!("{l}@{:.5}", track.tau[r.start])).collect::<Vec<_>>().join(" ")
            );
            println!(
                "       {}",
                events
                    .iter()
                    .map(|e| format!("{:.5} {}", e.0, e.1.split(' ').nth(1).unwrap()))
                    .collect::<Vec<_>>()
                    .join(" ")
            );
        }
    }
}

#[test]
#[ignore]
fn whole() {
    let sigma: f64 = std::env::var("SIGMA").unwrap_or("0".into()).parse().unwrap();
    let rho: f64 = std::env::var("RHO").unwrap_or("0".into()).parse().unwrap();
    let mut seed: u64 = std::env::var("SEED").unwrap_or("1".into()).parse().unwrap();
    use rod_contours::Contour;
    let rod = Rod::new(1.0, 1.0).unwrap();
    for o in 0..3 {
        for q in [0.2, 0.4, 0.6] {
            let (states, events, object) = scan(o, q, 2e-5);
            let mut gauss = || {
                let mut s = 0.0;
                for _ in 0..12 {
                    seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                    s += (seed >> 11) as f64 / (1u64 << 53) as f64;
                }
                s - 6.0
            };
            let mut ar = Vector3::zeros();
            let samples: Vec<crate::Sample> = states
                .iter()
                .map(|s| {
                    ar = ar * rho
                        + Vector3::new(gauss() * 0.04, gauss() * 0.04, gauss() * 0.0095) * f64::sqrt(1.0 - rho * rho);
                    let mut r = s.reactions;
                    r.f0x += ar.x * sigma;
                    r.f0y += ar.y * sigma;
                    r.m0z += ar.z * sigma;
                    crate::Sample::new(s.pose, r)
                })
                .collect();
            let t0 = std::time::Instant::now();
            let found = crate::reconstruct(&rod, &samples, &crate::Settings::default()).unwrap();
            let el = t0.elapsed();
            let (mut wrong, mut several, mut none) = (0, 0, 0);
            let mut errors = vec![];
            let mut worst = (0.0, 0);
            for (i, (r, st)) in found.readings.iter().zip(&states).enumerate() {
                let p = st.phase();
                let truth = crate::Label::of(p.contacts, p.tip);
                if truth != r.label {
                    wrong += 1;
                    if truth.several() != r.label.several() {
                        several += 1
                    }
                }
                if !r.label.several()
                    && !truth.several()
                    && r.label != crate::Label::Free
                    && truth != crate::Label::Free
                {
                    match r.touch {
                        Ok(t) => {
                            let e = object.closest(t.x, t.y).gap.abs();
                            if e > worst.0 {
                                worst = (e, i)
                            }
                            errors.push(e)
                        }
                        Err(_) => none += 1,
                    }
                }
            }
            errors.sort_by(f64::total_cmp);
            let n = errors.len();
            println!(
                "O{o} q{q} wrong {wrong} ({:.3} %) several {several} none {none} | points med {:.1e} 95 {:.1e} max {:.1e} at {:.4} | noise {:.1e} {:.2} {:.2} m {:.1e} | {el:?}",
                100.0 * wrong as f64 / states.len() as f64,
                errors[n / 2],
                errors[n * 95 / 100],
                errors[n - 1],
                0.8 - states[worst.1].pose.x,
                found.noise[0].sigma,
                found.noise[0].lag1,
                found.noise[0].long_run,
                found.noise[2].sigma
            );
            println!(
                "   {}",
                found
                    .runs
                    .iter()
                    .map(|(r, l)| format!("{l}@{:.5}", 0.8 - states[*r].pose.x))
                    .collect::<Vec<_>>()
                    .join(" ")
            );
            println!(
                "   {}",
                events
                    .iter()
                    .map(|e| format!("{:.5} {}", e.0, e.1.split(' ').nth(1).unwrap()))
                    .collect::<Vec<_>>()
                    .join(" ")
            );
            println!(
                "   kinks {}",
                found
                    .kinks
                    .iter()
                    .map(|k| format!("{:.5} ({:?} {:.0})", k.tau, k.kind, k.score))
                    .collect::<Vec<_>>()
                    .join(" ")
            );
        }
    }
}

#[test]
#[ignore]
fn live() {
    let sigma: f64 = std::env::var("SIGMA").unwrap_or("0".into()).parse().unwrap();
    let rho: f64 = std::env::var("RHO").unwrap_or("0".into()).parse().unwrap();
    let half: f64 = std::env::var("HALF").unwrap_or("0.02".into()).parse().unwrap();
    let mut seed = 1u64;
    let rod = Rod::new(1.0, 1.0).unwrap();
    for o in 0..3 {
        for q in [0.2, 0.4, 0.6] {
            let (states, _, object) = scan(o, q, 2e-5);
            let mut gauss = || {
                let mut s = 0.0;
                for _ in 0..12 {
                    seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                    s += (seed >> 11) as f64 / (1u64 << 53) as f64;
                }
                s - 6.0
            };
            let mut ar = Vector3::zeros();
            let samples: Vec<crate::Sample> = states
                .iter()
                .map(|s| {
                    ar = ar * rho
                        + Vector3::new(gauss() * 0.04, gauss() * 0.04, gauss() * 0.0095) * f64::sqrt(1.0 - rho * rho);
                    let mut r = s.reactions;
                    r.f0x += ar.x * sigma;
                    r.f0y += ar.y * sigma;
                    r.m0z += ar.z * sigma;
                    crate::Sample::new(s.pose, r)
                })
                .collect();
            let mut noise =
                [0.04, 0.04, 0.0095].map(|s| crate::noise_estimate::ChannelNoise::white((s * sigma).max(1e-14)));
            for n in &mut noise {
                n.long_run = (1.0 + rho) / (1.0 - rho);
                n.lag1 = rho;
            }
            let mut live = crate::Live::new(
                &rod,
                &crate::LiveSettings { half_window: half, ..crate::LiveSettings::new(noise, 2e-5) },
            )
            .unwrap();
            let t0 = std::time::Instant::now();
            let mut worst = std::time::Duration::ZERO;
            let mut out = Vec::new();
            for s in &samples {
                let t = std::time::Instant::now();
                if let Some(r) = live.push(s) {
                    out.push(r)
                }
                worst = worst.max(t.elapsed());
            }
            while let Some(r) = live.finish() {
                out.push(r)
            }
            let el = t0.elapsed();
            assert_eq!(out.len(), samples.len());
            let (mut wrong, mut several) = (0, 0);
            let mut errors = vec![];
            let mut runs = String::new();
            let mut last = None;
            use rod_contours::Contour;
            for (r, st) in out.iter().zip(&states) {
                let p = st.phase();
                let truth = crate::Label::of(p.contacts, p.tip);
                if last != Some(r.label) {
                    runs += &format!("{}@{:.4} ", r.label, 0.8 - st.pose.x);
                    last = Some(r.label);
                }
                if truth != r.label {
                    wrong += 1;
                    if truth.several() != r.label.several() {
                        several += 1
                    }
                } else if let Ok(t) = r.touch {
                    errors.push(object.closest(t.x, t.y).gap.abs())
                }
            }
            errors.sort_by(f64::total_cmp);
            println!(
                "O{o} q{q} delay {} wrong {:.3} % several {several} point med {:.1e} 95 {:.1e} | {:?}/sample worst {worst:?}: {runs}",
                live.delay(),
                100.0 * wrong as f64 / states.len() as f64,
                errors[errors.len() / 2],
                errors[errors.len() * 95 / 100],
                el / samples.len() as u32
            );
        }
    }
}
