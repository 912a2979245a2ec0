//! Every field of the good certificates altered in every way: each mutant is rejected, or what it
//! says is still true. Of what is accepted, the claim is the same, or follows from it by comparing
//! numbers, or is proved by hand, or looks true in floating point at every place looked at, unless
//! its numbers are too far apart for that. Nothing makes the checker crash or take long.

pub mod edits;
mod weaker;

use super::oracle::{opinion, Opinion};
use super::random::Random;
use edits::{edits, paths, texts, Kind};
use orthocert_checker::certificate::{Certificate, Proof, Verdict};
use orthocert_checker::claim::{Claim, Leg, Mechanism};
use orthocert_checker::number::Exact;
use orthocert_checker::{check, read};
use serde_json::{json, Value};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Mutex;
use std::thread;

/// Places at which an accepted claim is looked at that nothing else settles.
const SAMPLES: u64 = 200;
/// Most bytes of a certificate that mutants are made of.
const LONGEST: u64 = 10_000;
/// Into how many shares the edits of a certificate are dealt.
const SHARES: usize = 16;
/// Most processor time of a mutant: ten times the good file's, or this, in nanoseconds.
const LEAST_LIMIT: u64 = 50_000_000;

/// Why an accepted mutant is no worse than the certificate that it was made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Reason {
    SameClaim,
    Follows,
    ByHand,
    LooksTrue,
    /// Its numbers are too far apart for doubles to tell.
    BeyondDoubles,
}

/// What became of the mutants of a kind.
#[derive(Clone, Debug, Default)]
struct Count {
    mutants: usize,
    accepted: BTreeMap<Reason, usize>,
}

/// What became of all of them.
#[derive(Clone, Debug, Default)]
struct Tally {
    kinds: BTreeMap<Kind, Count>,
    /// The mutant that took longest, in nanoseconds of processor time, and how often as long as
    /// the good file it took.
    slowest: (u64, f64, String),
    wrong: Vec<String>,
}

/// A certificate that is accepted.
struct Good {
    name: String,
    text: String,
    value: Value,
    certificate: Certificate,
    nanoseconds: u64,
}

/// The processor time of this thread so far, in nanoseconds; always zero where the system does not
/// tell.
fn processor_time() -> u64 {
    let text = fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ').next().and_then(|first| first.parse().ok()).unwrap_or(0)
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, u64) {
    let start = processor_time();
    let result = work();
    (result, processor_time() - start)
}

fn accepted(bytes: &[u8]) -> Option<Certificate> {
    let certificate = read(bytes).ok()?;
    check(&certificate).ok()?;
    Some(certificate)
}

fn good_certificates() -> Vec<Good> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = ["../certificates", "tests/certificates"].map(|folder| root.join(folder));
    let entries = folders.iter().flat_map(|folder| fs::read_dir(folder).unwrap());
    let mut files: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    // The list of a long tree's edits is as long as the square of the tree.
    files.retain(|path| path.extension().is_some_and(|end| end == "json"));
    files.retain(|path| fs::metadata(path).unwrap().len() <= LONGEST);
    let all = files.iter().map(|path| {
        let text = fs::read_to_string(path).unwrap();
        let name = path.file_name().unwrap().to_str().unwrap().replace(".cert.json", "");
        let (certificate, nanoseconds) = timed(|| accepted(text.as_bytes()));
        let certificate = certificate.unwrap_or_else(|| panic!("{name} is not accepted"));
        Good { name, value: serde_json::from_str(&text).unwrap(), text, certificate, nanoseconds }
    });
    // Those of the kernel are for its own oracles.
    all.filter(|good| !matches!(good.certificate.proof, Proof::Kernel(_))).collect()
}

/// Why what a mutant says is true, or why it is not known to be.
fn reason(good: &Certificate, mutant: &Certificate) -> Result<Reason, String> {
    let mut random = Random::new(76);
    let looks = opinion(mutant, &mut random, SAMPLES);
    if let Opinion::Contradicts(why) = looks {
        return Err(why);
    }
    let (former, claim) = (&good.claim, &mutant.claim);
    let follows = match (good.verdict, mutant.verdict) {
        (Verdict::Certified, Verdict::Certified) => weaker::follows(claim, former),
        (Verdict::Refuted, Verdict::Refuted) => weaker::follows(former, claim),
        _ => false,
    };
    match (looks, mutant.verdict) {
        (_, verdict) if claim == former && verdict == good.verdict => Ok(Reason::SameClaim),
        _ if follows => Ok(Reason::Follows),
        (_, Verdict::Certified) if weaker::known(claim) => Ok(Reason::ByHand),
        (Opinion::Agrees, _) => Ok(Reason::LooksTrue),
        _ => Ok(Reason::BeyondDoubles),
    }
}

impl Tally {
    fn judge(&mut self, good: &Good, kind: Kind, bytes: &[u8], name: impl Fn() -> String) {
        let count = self.kinds.entry(kind).or_default();
        count.mutants += 1;
        let (mutant, nanoseconds) = timed(|| accepted(bytes));
        let ratio = nanoseconds as f64 / good.nanoseconds.max(1) as f64;
        if nanoseconds > self.slowest.0 {
            self.slowest = (nanoseconds, ratio, name());
        }
        if nanoseconds > LEAST_LIMIT.max(10 * good.nanoseconds) {
            self.wrong.push(format!("{}: {nanoseconds} ns, {ratio:.1} times", name()));
        }
        let Some(mutant) = mutant else { return };
        match reason(&good.certificate, &mutant) {
            Ok(reason) => *count.accepted.entry(reason).or_default() += 1,
            Err(why) => self.wrong.push(format!("{}: {why}", name())),
        }
    }

    /// The share `share` of the mutants of a certificate, of which one in `one_in` is taken.
    fn judge_share(&mut self, good: &Good, share: usize, one_in: usize) {
        let mut all = Vec::new();
        paths(&good.value, "", &mut all);
        let mut number = 0;
        for path in all.iter().skip(share).step_by(SHARES) {
            for (kind, other) in edits(path, good.value.pointer(path).unwrap()) {
                number += 1;
                if number % one_in != 0 {
                    continue;
                }
                let mut mutant = good.value.clone();
                let name = || format!("{} {path} = {:.80}", good.name, other.to_string());
                *mutant.pointer_mut(path).unwrap() = other.clone();
                self.judge(good, kind, mutant.to_string().as_bytes(), name);
            }
        }
        let mut number = 0;
        texts(&good.text, |bytes| {
            number += 1;
            if number % (SHARES * one_in) == share {
                let name = || format!("{}, text {number}", good.name);
                self.judge(good, Kind::Text, &bytes, name);
            }
        });
    }

    fn add(&mut self, other: Tally) {
        for (kind, count) in other.kinds {
            let sum = self.kinds.entry(kind).or_default();
            sum.mutants += count.mutants;
            for (reason, n) in count.accepted {
                *sum.accepted.entry(reason).or_default() += n;
            }
        }
        if other.slowest.0 > self.slowest.0 {
            self.slowest = other.slowest;
        }
        self.wrong.extend(other.wrong);
    }

    fn table(&self) -> String {
        let reasons = [
            Reason::SameClaim,
            Reason::Follows,
            Reason::ByHand,
            Reason::LooksTrue,
            Reason::BeyondDoubles,
        ];
        let mut text =
            "| kind | mutants | rejected | same claim | follows | by hand | looks true | too far |\n\
             |---|---|---|---|---|---|---|---|\n"
                .to_owned();
        for (kind, count) in &self.kinds {
            let accepted = reasons.map(|reason| count.accepted.get(&reason).copied().unwrap_or(0));
            let rejected = count.mutants - accepted.iter().sum::<usize>();
            let cells = accepted.map(|n| n.to_string()).join(" | ");
            text += &format!("| {kind:?} | {} | {rejected} | {cells} |\n", count.mutants);
        }
        text
    }
}

/// Judges the mutants of every certificate: of one of so many bytes, one in `one_in(bytes)`.
fn judge_all(one_in: impl Fn(usize) -> usize + Sync) {
    let good = good_certificates();
    let (next, total) = (AtomicUsize::new(0), Mutex::new(Tally::default()));
    let work = || {
        let mut tally = Tally::default();
        loop {
            let job = next.fetch_add(1, Ordering::Relaxed);
            let Some(good) = good.get(job / SHARES) else { break };
            tally.judge_share(good, job % SHARES, one_in(good.text.len()));
        }
        total.lock().unwrap().add(tally);
    };
    let threads = thread::available_parallelism().map_or(1, |n| n.get());
    thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    let tally = total.into_inner().unwrap();
    let (slowest, ratio, name) = &tally.slowest;
    println!("{}", tally.table());
    println!("slowest: {:.1} ms, {ratio:.1} times the good file's: {name}", *slowest as f64 / 1e6);
    assert!(tally.wrong.is_empty(), "{}: {:#.4000?}", tally.wrong.len(), tally.wrong);
    for (kind, count) in &tally.kinds {
        let accepted = count.accepted.values().sum::<usize>();
        assert!(count.mutants > 20 && accepted < count.mutants, "{kind:?}: {count:?}");
    }
}

#[test]
fn mutants_of_certificates_are_rejected_or_true() {
    // Of small ones, every mutant; an odd number does not keep step with lists of even lengths.
    judge_all(|bytes| if bytes <= 1000 { 1 } else { 3 + 2 * (bytes / 300) });
}

/// `cargo test --release -p orthocert-checker --test integration -- --ignored --nocapture`
#[test]
#[ignore = "takes many minutes"]
fn every_mutant_of_every_certificate_is_rejected_or_true() {
    judge_all(|_| 1);
}

#[test]
fn the_oracle_is_not_blind() {
    let mut random = Random::new(77);
    let impossible = [
        ("parallel_margin", json!({"min": "1001/1000"})),
        ("joint_speed", json!({"tool": "1000000", "max": "1"})),
        ("joint_range", json!([{"min": "-1e9", "max": "-1e9"}, {}, {}])),
        ("transmission", json!({"min": "1000", "max": "1001"})),
        ("transmission", json!({"min": "1/1001", "max": "1/1000"})),
    ];
    let (mut good_ones, mut seen) = (0, 0);
    for good in good_certificates() {
        // What no place of one machine can show.
        if matches!(good.certificate.claim, Claim::NoCube(_) | Claim::Atlas(_)) {
            continue;
        }
        let looks = opinion(&good.certificate, &mut random, SAMPLES);
        assert_eq!(looks, Opinion::Agrees, "{}", good.name);
        good_ones += 1;
        for (name, requirement) in &impossible {
            let mut value = good.value.clone();
            if good.certificate.verdict == Verdict::Refuted || value["claim"]["machine"].is_null() {
                continue;
            }
            let requirements = &mut value["claim"]["machine"]["requirements"];
            // On the cube, any psi_max > 1 is met.
            if *name == "transmission" && good.text.contains("cube") {
                continue;
            }
            requirements[name] = requirement.clone();
            let Ok(certificate) = read(value.to_string().as_bytes()) else { continue };
            let looks = opinion(&certificate, &mut random, SAMPLES);
            assert!(matches!(looks, Opinion::Contradicts(_)), "{}: {name}", good.name);
            seen += 1;
        }
    }
    assert!(good_ones >= 16 && seen > 20, "{good_ones}, {seen}");
}

/// Legs so long that the square of their length overflows make `M` nearly the identity.
#[test]
fn beyond_doubles_the_oracle_is_silent() {
    let mut random = Random::new(78);
    let good = good_certificates();
    let good = good.iter().find(|good| good.name == "orthoglide-relaxed-1-percent").expect("it");
    for (factor, silent) in [("1", false), ("1e50", false), ("1e200", true), ("1e400", true)] {
        let mut certificate = good.certificate.clone();
        let Claim::Machine(claim) = &mut certificate.claim else { panic!("a machine") };
        let Mechanism::Translational(legs) = &mut claim.mechanism else { panic!("legs") };
        for leg in legs {
            let Leg::Slider { length, .. } = leg else { panic!("sliders") };
            for end in [&mut length.min, &mut length.max] {
                let factor = Exact::parse(factor, 10).expect("a number");
                *end = end.clone().times(factor).expect("a number");
            }
        }
        check(&certificate).expect("longer legs are still good");
        let looks = opinion(&certificate, &mut random, SAMPLES);
        assert_eq!(looks == Opinion::None, silent, "{factor}: {looks:?}");
    }
}
