//! The broken certificates of `tests/rejected`: good ones, edited, and what they are rejected for.
//!
//! | line              | is                                                                  |
//! |-------------------|---------------------------------------------------------------------|
//! | `NAME: BASE`      | of a committed certificate, of one before it, or of `nothing`       |
//! | `- TEXT`          | the first occurrence of this                                        |
//! | `+ TEXT`          | is replaced by this                                                 |
//! | `! KIND: WORDS`   | the variant of the rejection, and words of the reason               |
//!
//! In a text, `⏎` ends a line, `⟨3·ab⟩` is `ababab`, and `⟨ff⟩` is a byte in hexadecimal.

/// A broken certificate.
pub struct Broken {
    pub name: &'static str,
    pub bytes: Vec<u8>,
    /// The variant of the rejection.
    #[allow(dead_code, reason = "the tests of the schema have their own")]
    pub kind: &'static str,
    /// Words of the reason.
    #[allow(dead_code, reason = "the tests of the schema have their own")]
    pub words: &'static str,
}

macro_rules! patches {
    ($($name:literal),*) => {
        [$(include_str!(concat!("../../../../tests/rejected/", $name, ".patches"))),*]
    };
}

macro_rules! certificates {
    ($folder:literal: $($name:literal),*) => {
        [$(($name, include_str!(concat!($folder, $name, ".cert.json")))),*]
    };
}

const PATCHES: [&str; 12] = patches!(
    "bytes",
    "integers",
    "numbers",
    "keys",
    "shapes",
    "names",
    "verdicts",
    "claims",
    "trees",
    "steps",
    "postulate",
    "witnesses"
);

const OF_THE_RULES: [(&str, &str); 5] = certificates!(
    "../certificates/":
    "orthoglide-prototype",
    "orthoglide-tolerance",
    "orthoglide-310",
    "orthoglide-joint-range",
    "orthoglide-relaxed-1-percent"
);
const COMMITTED: [(&str, &str); 2] =
    certificates!("../../../certificates/": "postulate-all", "postulate-1.37");

/// All of them.
pub fn all() -> Vec<Broken> {
    let mut all = Vec::new();
    for patches in PATCHES {
        for patch in patches.split("\n\n").filter(|patch| !patch.starts_with('#')) {
            let broken = patched(patch.trim_end(), &all);
            all.push(broken);
        }
    }
    all
}

fn patched(patch: &'static str, before: &[Broken]) -> Broken {
    let (head, edits) = patch.split_once('\n').unwrap();
    let (name, base) = head.split_once(": ").unwrap_or_else(|| panic!("{head}"));
    let mut broken = Broken { name, bytes: certificate(base, before), kind: "", words: "" };
    let mut found = 0..0;
    for line in edits.lines() {
        let (sign, text) = line.split_once(' ').unwrap_or((line, ""));
        match sign {
            "-" => {
                found = occurrence(&broken.bytes, &bytes(text)).unwrap_or_else(|| panic!("{patch}"))
            }
            "+" => drop(broken.bytes.splice(found.clone(), bytes(text))),
            "!" => (broken.kind, broken.words) = text.split_once(": ").unwrap(),
            _ => panic!("{patch}"),
        }
    }
    broken
}

fn certificate(name: &str, before: &[Broken]) -> Vec<u8> {
    let mut good = OF_THE_RULES.iter().chain(&COMMITTED);
    let committed = good.find(|known| known.0 == name).map(|known| known.1.into());
    let broken = before.iter().find(|known| known.name == name).map(|known| known.bytes.clone());
    let nothing = (name == "nothing").then(Vec::new);
    committed.or(broken).or(nothing).unwrap_or_else(|| panic!("{name} is unknown"))
}

fn occurrence(bytes: &[u8], text: &[u8]) -> Option<std::ops::Range<usize>> {
    let starts = 0..=bytes.len().checked_sub(text.len())?;
    starts.map(|at| at..at + text.len()).find(|range| &bytes[range.clone()] == text)
}

fn bytes(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (i, part) in text.replace('⏎', "\n").split(['⟨', '⟩']).enumerate() {
        // Every second part stood in brackets.
        match (i % 2, part.split_once('·')) {
            (0, _) => bytes.extend(part.bytes()),
            (_, Some((count, unit))) => bytes.extend(unit.repeat(count.parse().unwrap()).bytes()),
            (_, None) => bytes.push(u8::from_str_radix(part, 16).unwrap()),
        }
    }
    bytes
}
