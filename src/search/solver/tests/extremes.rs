//! Extremes, and values at places.

use super::kinds::three_rpr;
use super::*;
use crate::design::Design;
use crate::questions::frontier::Bracket;
use crate::questions::tolerance::{widest, Kind, Known, Scheme};
use crate::search::solver::enclose::{
    enclose, loosest, narrowest, singular, Enclosed, NotEnclosed, Sought,
};
use crate::search::solver::extremes::Extreme;
use crate::search::solver::value::Bounded;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use orthocert_kernel::quantity::Test;

fn all(claim: &MachineClaim, wanted: &[&str], relative: (i64, i64)) -> Vec<(String, Enclosed)> {
    let legs = Problem::new(claim).expect("a claim").legs.len();
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    let budget = Budget { max_boxes: 5_000, deadline: None };
    let width = BigRational::new(relative.0.into(), relative.1.into());
    let of = |extreme: &Extreme| {
        let name = extreme.file_stem();
        let found = enclose((claim, false), extreme, &width, budget, &mut control);
        (name.clone(), found.unwrap_or_else(|error| panic!("{name}: {error}")))
    };
    let every = Extreme::of(claim, legs);
    let wanted = every.iter().filter(|one| wanted.contains(&&*one.file_stem()));
    wanted.map(of).collect()
}

#[test]
fn extremes_are_enclosed() {
    let claim = orthoglide("\"310.7\"", CUBE);
    let [least, greatest] = psi(&claim);
    let found = all(
        &claim,
        &["psi-least", "psi-greatest", "rho-2-greatest", "serial-margin", "leg-angle"],
        (1, 1_000_000),
    );
    let approximate = |x: &BigRational| x.to_f64().expect("finite");
    // At (-72, 125, 125) the guide's component of leg 1 is least.
    let eta = (310.7f64.powi(2) - 2.0 * 125f64.powi(2)).sqrt();
    let expected = [
        ("psi-least", least),
        ("psi-greatest", greatest),
        ("rho-2-greatest", 125.0 - eta),
        ("serial-margin", eta / 310.7),
        ("leg-angle", (eta / 310.7).acos().to_degrees()),
    ];
    assert_eq!(found.len(), expected.len());
    for ((name, enclosed), (wanted, value)) in found.iter().zip(expected) {
        assert_eq!(name, wanted);
        let ends = [approximate(&enclosed.inner), approximate(&enclosed.outer)];
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        assert!(low <= value && value <= high, "{name}: {value} in [{low}, {high}]");
        assert!(high - low < 2e-6 * 383.0f64.max(value.abs()), "{name}: [{low}, {high}]");
        assert_eq!(enclosed.certified.verdict, Verdict::Certified);
        let refuted = enclosed.refuted.as_ref().expect("a refutation");
        assert_eq!(refuted.verdict, Verdict::Refuted);
        assert!(check(&enclosed.certified).is_ok() && check(refuted).is_ok());
    }
}

#[test]
fn extremes_of_formulas_are_those_of_legs() {
    let wanted = ["psi-least", "psi-greatest", "conditioning"];
    let ends = |claim: &MachineClaim| -> Vec<[BigRational; 2]> {
        let found = all(claim, &wanted, (1, 10_000)).into_iter();
        found
            .map(|(_, found)| {
                [found.inner.clone().min(found.outer.clone()), found.inner.max(found.outer)]
            })
            .collect()
    };
    let (legs, formulas) = (ends(&orthoglide("\"310.7\"", CUBE)), ends(&orthoglide_by_formulas()));
    assert_eq!((legs.len(), formulas.len()), (3, 3));
    for ([a, b], [c, d]) in legs.iter().zip(&formulas) {
        // Both hold the extreme.
        assert!(a <= d && c <= b);
    }
}

#[test]
fn extremes_of_a_platform_that_turns() {
    let claim = three_rpr();
    let found = all(&claim, &["psi-greatest", "rho-1-greatest", "conditioning"], (1, 1_000));
    assert_eq!(found.len(), 3);
    let (_, greatest) = &found[0];
    let [_, sampled] = psi(&claim);
    let ends = [&greatest.inner, &greatest.outer].map(|x| x.to_f64().expect("finite"));
    assert!(ends[0] < sampled && sampled < ends[1], "{sampled} in {ends:?}");
}

#[test]
fn a_looser_bound_goes_on_where_a_tighter_one_stopped() {
    let claim = three_rpr();
    let every = Extreme::of(&claim, 3);
    let psi = every.iter().find(|one| one.file_stem() == "psi-greatest").expect("psi");
    let cancel = AtomicBool::new(false);
    let control = &mut Control { cancel: &cancel, progress: &mut |_| {} };
    let mut enclosed = |boxes| {
        let budget = Budget { max_boxes: boxes, deadline: None };
        let width = BigRational::new(1.into(), 10_000_000.into());
        enclose((&claim, false), psi, &width, budget, control).unwrap()
    };
    let most = enclosed(5_000);
    // Short of one box at the first width, it goes on from all others.
    let less = enclosed(most.boxes - 1);
    // Twice as far outside, and refuted as near as before.
    assert_eq!(less.width, &most.width * BigRational::new(5.into(), 3.into()));
    assert_eq!(less.inner, most.inner);
    assert!(less.boxes >= most.boxes - 1 && less.boxes <= most.boxes + 8, "{}", less.boxes);
    assert!(less.outer > most.outer);
}

#[test]
fn a_singular_machine_has_none() {
    let claim =
        orthoglide("\"310.7\"", r#"{"box":{"min":["-72","-72","-72"],"max":["222","222","222"]}}"#);
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    let budget = Budget { max_boxes: 1000, deadline: None };
    assert!(singular(&claim, budget, &mut control).expect("a claim").is_some());
}

#[test]
fn tolerances_are_enclosed_to_second_order() {
    // Thirty numbers with tolerances of 1e-4 or so; in ranges the widths are 1e-3 to 3e-2.
    let file = "tests/designs/orthoglide-as-built.toml";
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let claim = Design::read(&file).expect("a design").claim;
    let wanted = ["psi-least", "psi-greatest", "rho-1-greatest", "parallel-margin", "joint-force"];
    let found = all(&claim, &wanted, (1, 5_000));
    assert_eq!(found.len(), wanted.len());
    for (name, found) in &found {
        assert!(found.width <= BigRational::new(1.into(), 2_500.into()), "{name}: {}", found.width);
        let Proof::Tree(tree) = &found.certified.proof else { panic!("a tree") };
        assert!(tree.takes_tolerances_apart(), "{name}");
    }
    // No machine is worse than what is certified, and some is nearly as bad.
    let problem = Problem::new(&claim).expect("a claim");
    let sampler = Sampler::new(&claim, &problem).expect("numbers");
    let number = problem.obligations.iter().position(|o| matches!(o.test, Test::SigmaMin(_)));
    let bounded = Bounded::of(&claim, &problem, number.expect("psi from above")).expect("psi");
    let (_, psi) = found.iter().find(|(name, _)| name == "psi-greatest").expect("psi");
    let outer = psi.outer.to_f64().expect("finite");
    let (mut state, mut greatest) = (7u32, 0f64);
    let mut part = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        [0.0, 1.0, f64::from(state) / f64::from(u32::MAX)][(state >> 13) as usize % 3]
    };
    for _ in 0..20_000 {
        let mut place = sampler.centre();
        place.u.iter_mut().chain(&mut place.t).for_each(|x| *x = part());
        let value = bounded.value(&claim, &problem, &sampler, &place).expect("a value");
        greatest = greatest.max(value);
    }
    assert!(greatest <= outer && greatest > 0.99 * outer, "{greatest} {outer}");
}

/// Directions known to 0.6 degrees: by first derivatives the widths are 4e-3, 1e-3 and 4e-3, whatever the boxes.
#[test]
fn extremes_of_wide_tolerances_are_enclosed_by_second_derivatives() {
    let file = "tests/designs/orthoglide-wide-tolerance.toml";
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let claim = Design::read(&file).expect("a design").claim;
    for (name, found) in all(&claim, &["psi-greatest", "rho-1-least", "joint-force"], (1, 1_500)) {
        assert!(found.width <= BigRational::new(1.into(), 1_500.into()), "{name}: {}", found.width);
        let Proof::Tree(tree) = &found.certified.proof else { panic!("a tree") };
        let text = serde_json::to_string(tree).expect("a text");
        assert!(text.contains(['<', '=', '>']), "{name}");
        assert!(check(&found.certified).is_ok() && found.refuted.is_some(), "{name}");
    }
}

/// Of rods of 110 +- 20 no box of any size holds: the ranges are divided.
#[test]
fn extremes_of_wide_tolerances_are_enclosed_in_parts() {
    let one = ("psi-greatest", (1, 50));
    let cases = [
        ("kernel/five-bar-rough", ("parallel-margin", (1, 50))),
        ("kernel/five-bar-rough", one),
        ("kernel/five-bar-rough", ("psi-least", (1, 1_000))),
        ("kernel/five-bar-rough", ("joint-force", (1, 200))),
        // Without directions apart none is shown.
        ("linapod-wide-directions", ("conditioning", (1, 10))),
    ];
    for (design, (name, relative)) in cases {
        let file = format!("{}/tests/designs/{design}.toml", env!("CARGO_MANIFEST_DIR"));
        let claim = Design::read(file.as_ref()).expect("a design").claim;
        let [(_, found)] = &all(&claim, &[name], relative)[..] else { panic!("{name}") };
        assert!(found.width <= BigRational::new(relative.0.into(), relative.1.into()), "{name}");
        let Proof::Tree(tree) = &found.certified.proof else { panic!("a tree") };
        let m = Problem::new(&claim).expect("a claim").dimension();
        assert!(tree.nodes.iter().any(|node| node.split.is_some_and(|k| k >= m)), "{name}");
        assert!(check(&found.certified).is_ok() && found.refuted.is_some(), "{name}");
    }
}

/// Of a 3-PRR with guides within 0.042 in each component no parts are shown without directions apart: what is refuted is 0.0439.
/// Of an Orthoglide with guides within 0.097 derivatives are not defined over all of it.
#[test]
fn wide_directions_are_shown_in_parts() {
    let cases = [
        ("kernel/planar-3-prr", "min = [-40, -40]", "min = [30, -40]", (42, 1000)),
        ("orthoglide-wide-tolerance", "min = [-50, -50, -50]", "min = [79, 79, 79]", (97, 1000)),
    ];
    for (design, whole, part, (t, of)) in cases {
        let file = format!("{}/tests/designs/{design}.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&file).expect("a file");
        assert!(text.contains(whole), "{design}");
        let claim = Design::parse(&text.replace(whole, part), design).expect("a design").claim;
        let t = BigRational::new(t.into(), of.into());
        let claim = Scheme::common(&[Kind::Direction]).claim(&claim, &t);
        let cancel = AtomicBool::new(false);
        let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
        let budget = Budget { max_boxes: 8_000, deadline: None };
        let found =
            proof(&claim, budget, &mut control).unwrap_or_else(|e| panic!("{design}: {e:?}"));
        let Proof::Tree(tree) = &found.proof else { panic!("a tree") };
        let m = Problem::new(&claim).expect("a claim").dimension();
        assert!(tree.nodes.iter().any(|node| node.split.is_some_and(|k| k >= m)), "{design}");
        assert!(check(&found).is_ok(), "{design}");
    }
}

/// Where the middle machine is farthest from failing: with the left rod 126 long, of 110 +- 20, psi is 56.657, as a scan of
/// points and machines with numpy's singular values has it.
#[test]
fn a_machine_within_the_tolerance_refutes_on_the_spot() {
    let file = "tests/designs/kernel/five-bar-rough.toml";
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let mut claim = Design::read(&file).expect("a design").claim;
    for (bound, is_refuted) in [(56.6, false), (56.7, true), (60.0, true)] {
        claim.require = vec![require("transmission", Bound::Min(decimal(bound)))];
        let cancel = AtomicBool::new(false);
        let budget = Budget { max_boxes: 1, deadline: None };
        let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
        let found = verify(&claim, budget, &mut control).expect("a claim");
        let on_the_spot = matches!(found.answer, Answer::Decided { .. }) && found.boxes == 0;
        assert_eq!(on_the_spot, is_refuted, "{bound}");
    }
}

/// Values by definition are the bounds that are met with equality.
#[test]
fn values_are_tight_bounds() {
    for claim in [orthoglide(r#"{"min":"311","max":"312"}"#, CUBE), rotary()] {
        let mut claim = claim;
        let angular = Problem::new(&claim).expect("a claim").legs[0].is_angular();
        claim.require = vec![
            require("serial_margin", Bound::Min(decimal(0.4))),
            require("conditioning", Bound::Max(decimal(4.0))),
            require("transmission", Bound::Min(decimal(0.7))),
            Requirement {
                given: [("tool".to_owned(), vec![Expression::integer(3)])].into(),
                ..require("joint_speed", Bound::Max(decimal(30.0)))
            },
        ];
        if !angular {
            claim.require.push(require("leg_angle", Bound::Max(decimal(50.0))));
        }
        let problem = Problem::new(&claim).expect("a claim");
        let sampler = Sampler::new(&claim, &problem).expect("numbers");
        let mut place = sampler.centre();
        place.u = vec![0.3, 0.9, 0.6];
        place.t.iter_mut().for_each(|t| *t = 0.25);
        let mut compared = 0;
        for number in 0..problem.obligations.len() {
            let Some(bounded) = Bounded::of(&claim, &problem, number) else { continue };
            let value = bounded.value(&claim, &problem, &sampler, &place).expect("a value");
            let tight = bounded.tight(&claim, &place).expect("a bound");
            let name = bounded.name();
            assert!((value - tight).abs() < 1e-9 * value.abs(), "{name}: {value}, {tight}");
            compared += 1;
        }
        assert_eq!(compared, problem.obligations.len() - 1);
    }
}

#[test]
fn descents_find_edges_and_insides() {
    // The middle of an edge, and of the inside, of a machine given by x and y alone.
    let claim = five_bar();
    let claim = with_psi(&claim, 1.0, 1.0);
    let problem = Problem::new(&claim).expect("a claim");
    let sampler = Sampler::new(&claim, &problem).expect("numbers");
    for quality in sampler.qualities() {
        let start = Place { u: vec![0.9, 0.8], t: vec![] };
        let found = sampler.descend(quality, &start, 26);
        for place in sampler.grid() {
            let margin = sampler.margin(quality, &sampler.at(&place));
            assert!(found.margin <= margin + 1e-9, "{quality:?}: {} {margin}", found.margin);
        }
    }
}

/// The widths that are tried, in those asked for, where those from `holds` on are found and time is up
/// after `most`; and what is found.
fn widths(holds: i64, is_short: bool, most: usize) -> (Vec<i64>, Result<Option<i64>, ()>) {
    let asked = loosest() / BigRational::from_integer(800.into());
    let mut tried = Vec::new();
    let found = narrowest(&asked, is_short, |width| {
        if tried.len() == most {
            return Err(NotEnclosed::Undecided);
        }
        let times = (width / &asked).to_integer().to_i64().expect("a word");
        tried.push(times);
        Ok((times >= holds).then_some(times))
    });
    (tried, found.map_err(|_| ()))
}

#[test]
fn what_was_found_before_time_is_up_stays() {
    let all = usize::MAX;
    assert_eq!(widths(1, false, all), (vec![1], Ok(Some(1))));
    assert_eq!(widths(100, false, all), (vec![1, 800, 32, 128, 64], Ok(Some(128))));
    assert_eq!(widths(801, false, all), (vec![1, 800, 1600], Ok(Some(1600))));
    assert_eq!(widths(6401, false, all), (vec![1, 800, 1600, 3200, 6400], Ok(None)));
    assert_eq!(widths(1, true, all), (vec![800, 32, 1], Ok(Some(1))));
    assert_eq!(widths(8, true, all), (vec![800, 32, 1, 4, 8], Ok(Some(8))));
    assert_eq!(widths(100, true, all), (vec![800, 32, 128, 64], Ok(Some(128))));
    assert_eq!(widths(3200, true, all), (vec![800, 1600, 3200], Ok(Some(3200))));
    assert_eq!(widths(801, true, 1), (vec![800], Err(())));
    assert_eq!(widths(1, true, 2), (vec![800, 32], Ok(Some(32))));
    assert_eq!(widths(1, true, 0), (vec![], Err(())));
    assert_eq!(widths(1, false, 0), (vec![], Err(())));
}

pub fn of_file(design: &str) -> MachineClaim {
    let file = format!("{}/tests/designs/{design}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&file).expect("a file");
    Design::parse(&text, design).expect("a design").claim
}

/// What took few boxes is not begun again, and the tree is the same; where a box was hopeless, none follows.
#[test]
fn a_tree_goes_on_from_few_boxes() {
    let claim = of_file("delta-conditioning");
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    for (t, is_hopeless) in [(1, false), (4, true)] {
        let t = BigRational::from_integer(t.into());
        let claim = Scheme::common(&[Kind::LegLength]).claim(&claim, &t);
        let problem = with_derivatives(Problem::new(&claim).expect("a claim"));
        let prover = Prover::new(&problem).expect("numbers");
        let budget = Budget { max_boxes: 4000, deadline: None };
        let mut begin = |most| search(&prover, Ends::default(), budget.at_most(most), &mut control);
        let before = begin(if is_hopeless { 1000 } else { 100 });
        assert_eq!(before.stop, Stop::Boxes, "{}", before.boxes);
        let whole = if is_hopeless { before.clone() } else { begin(4000) };
        let ways = Ways::new(&prover, (&[], 0), budget);
        let found = ways.boxes_after(Some(before), true, &mut control);
        assert_eq!(found.stop == Stop::Hopeless, is_hopeless);
        assert_eq!(found.is_proof(), !is_hopeless);
        assert_eq!(found.boxes, whole.boxes);
        assert!(found.nodes == whole.nodes);
    }
}

/// What is known of the widest tolerance is kept, and the certified end goes on from there; with no time left, that is said.
#[test]
fn a_known_tolerance_is_improved() {
    let claim = of_file("delta-joint-speed");
    let scheme = Scheme::common(&[Kind::LegLength]);
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    let mut found = |gap, ends, deadline| {
        let budget = Budget { max_boxes: 2_000, deadline };
        let known = Known { ends, ..Known::default() };
        widest(&claim, &scheme, gap, known, budget, &mut control).expect("an answer")
    };
    let none = found(0.01, Bracket::default(), Some(std::time::Instant::now()));
    assert!(none.out_of_time && none.certified.is_none());
    let coarse = found(0.5, Bracket::default(), None);
    let fine = found(0.01, Bracket::default(), None);
    assert!(!fine.out_of_time);
    let first = Bracket { certified: coarse.certified, ..fine };
    let second = found(0.01, first.clone(), None);
    assert!(!second.out_of_time && second.reaches(0.01));
    let value = |end: &Option<(BigRational, _)>| end.as_ref().expect("an end").0.clone();
    assert_eq!(value(&second.refuted), value(&first.refuted));
    assert!(value(&second.certified) > value(&first.certified));
    let third = found(0.01, second.clone(), Some(std::time::Instant::now()));
    assert!(third.out_of_time && value(&third.certified) == value(&second.certified));
}

/// Where no narrower proof is found, an extreme is enclosed by the claim's own bound, if it has a rational one that holds.
#[test]
fn an_extreme_may_be_enclosed_by_its_own_bound() {
    let cancel = AtomicBool::new(false);
    let mut control = Control { cancel: &cancel, progress: &mut |_| {} };
    let budget = Budget { max_boxes: 5_000, deadline: None };
    let mut outer = |require: &[Requirement], stem: &str| {
        let claim = MachineClaim { require: require.to_vec(), ..linear_delta(SLAB) };
        let all = Extreme::of(&claim, 3);
        let own = all.iter().find(|one| one.file_stem() == stem).expect("an extreme");
        let found = Sought::new(&claim, own).ok()?.as_required(budget, &mut control).ok()?;
        assert!(found.refuted.is_some());
        if stem == "conditioning" {
            let width = ((&found.outer - &found.inner) / &found.inner).to_f64()?;
            assert!((found.width.to_f64()? / width - 1.0).abs() < 0.05);
        }
        found.outer.to_f64()
    };
    let exactly = |x: &str| Expression::try_from(x.to_owned()).expect("a number");
    let conditioning = |x: &str| require("conditioning", Bound::Max(exactly(x)));
    let both = [conditioning("5"), conditioning("4")];
    assert_eq!(outer(&both, "conditioning"), Some(4.0));
    for none in ["sqrt(17)", "1.01"] {
        assert_eq!(outer(&[conditioning(none)], "conditioning"), None, "{none}");
    }
    assert_eq!(outer(&both, "parallel-margin"), None);
    let range = Bound::Within(["-400", "400"].map(exactly));
    let of_leg_2 = [Requirement { leg: Some(2), ..require("joint_range", range) }];
    assert_eq!(outer(&of_leg_2, "rho-2-least"), Some(-400.0));
    assert_eq!(outer(&of_leg_2, "rho-2-greatest"), Some(400.0));
    assert_eq!(outer(&of_leg_2, "rho-1-greatest"), None);
    // Of a unit of tool speed it is the sixtieth part.
    let given = [("tool".to_owned(), vec![exactly("60")])].into();
    let speed = [Requirement { given, ..require("joint_speed", Bound::Max(exactly("180"))) }];
    assert_eq!(outer(&speed, "joint-speed"), Some(3.0));
}
