//! The macros that a header defines, as far as they can be known without its compiler.
//!
//! A conditional may depend on macros of other headers: of boards, of the toolchain. A name that no
//! line of the configuration defines, not even a commented-out one, is such; a name that only
//! commented-out lines define is an option that is switched off. What such a conditional encloses
//! is neither defined nor undefined here: whoever needs it learns on which name it depends.

use super::condition;
use super::source::{lines, tokens, Token};
use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

/// A name on whose definition elsewhere something depends, and the conditional that asks for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Doubt {
    /// The name.
    pub name: String,
    /// The file of the conditional.
    pub file: String,
    /// Its line.
    pub line: usize,
}

/// Whether something holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Truth {
    /// It does.
    Yes,
    /// It does not.
    No,
    /// It depends.
    Unknown(Doubt),
}

impl Truth {
    /// That of a condition.
    pub fn of(holds: bool) -> Truth {
        if holds {
            Truth::Yes
        } else {
            Truth::No
        }
    }

    /// Whether both hold.
    pub fn and(self, other: impl FnOnce() -> Truth) -> Truth {
        match self {
            Truth::No => Truth::No,
            Truth::Yes => other(),
            unknown => match other() {
                Truth::No => Truth::No,
                _ => unknown,
            },
        }
    }

    /// Whether it does not hold.
    pub fn not(self) -> Truth {
        match self {
            Truth::Yes => Truth::No,
            Truth::No => Truth::Yes,
            unknown => unknown,
        }
    }

    /// Whether one of them holds.
    pub fn or(self, other: impl FnOnce() -> Truth) -> Truth {
        self.not().and(|| other().not()).not()
    }
}

/// What a name stands for.
#[derive(Clone, Debug)]
pub(super) enum Body {
    /// Its replacement.
    Tokens(Vec<Token>),
    /// A macro with parameters, which is not expanded.
    Function,
    /// It is defined or not, one way or another, depending on another name.
    Depends(Doubt),
}

/// A definition.
#[derive(Clone, Debug)]
pub(super) struct Macro {
    /// The file.
    pub file: String,
    /// The line.
    pub line: usize,
    /// The replacement as it is written.
    pub text: String,
    /// What the name stands for.
    pub body: Body,
}

/// Why an expansion has no end result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Problem {
    /// It depends on a name that is not known.
    Depends(Doubt),
    /// It has more tokens than are read.
    TooLong,
}

/// Most tokens of all expansions together, and most expansions within each other.
const MOST_TOKENS: usize = 1_000_000;
const MOST_DEPTH: usize = 64;

/// The macros at one point of a header.
#[derive(Debug, Default)]
pub(super) struct Macros {
    table: BTreeMap<String, Macro>,
    options: BTreeSet<String>,
    expanded: Cell<usize>,
    /// Included headers, with file and line.
    pub included: Vec<(String, usize, String)>,
    /// Where the compiler would stop, with file and line.
    pub errors: Vec<(String, usize, String)>,
}

/// A conditional that is open.
struct Branch {
    /// Whether the lines of this branch are read.
    active: Truth,
    /// Whether this or an earlier branch was taken.
    taken: Truth,
    /// Whether there was an `#else`.
    last: bool,
}

impl Macros {
    /// Reads another header.
    ///
    /// # Errors
    /// The line of a directive that no compiler takes: an `#else` without `#if`, an `#if` without
    /// `#endif`, a `#define` without a name.
    pub fn read(&mut self, text: &str, file: &str) -> Result<(), usize> {
        self.options.extend(text.lines().filter_map(option));
        let mut open: Vec<(usize, Branch)> = Vec::new();
        for line in lines(text) {
            // Another spelling of `#`.
            if line.text.trim_start().starts_with("%:") {
                return Err(line.number);
            }
            let Some(directive) = line.text.trim_start().strip_prefix('#') else { continue };
            let directive = directive.trim();
            let end = directive.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(directive.len());
            let (name, rest) = directive.split_at(end);
            let at = Place { file, line: line.number };
            match name {
                // Of C23 and C++23; not in Marlin's language.
                "elifdef" | "elifndef" => return Err(line.number),
                "if" | "ifdef" | "ifndef" | "elif" | "else" | "endif" => {
                    self.conditional(name, rest, at, &mut open).ok_or(line.number)?;
                }
                _ => {
                    let active =
                        open.last().map_or(Truth::Yes, |(_, branch)| branch.active.clone());
                    self.directive(name, rest, at, active).ok_or(line.number)?;
                }
            }
        }
        open.first().map_or(Ok(()), |(line, _)| Err(*line))
    }

    fn conditional(
        &self,
        name: &str,
        rest: &str,
        at: Place<'_>,
        open: &mut Vec<(usize, Branch)>,
    ) -> Option<()> {
        if name == "endif" {
            open.pop()?;
            return Some(());
        }
        let (line, earlier) = match name {
            "elif" | "else" => open.pop().filter(|(_, branch)| !branch.last)?,
            _ => (at.line, Branch { active: Truth::No, taken: Truth::No, last: false }),
        };
        let outer = open.last().map_or(Truth::Yes, |(_, branch)| branch.active.clone());
        let free = outer.and(|| earlier.taken.clone().not());
        let holds = match name {
            _ if free == Truth::No => Truth::No,
            "else" => Truth::Yes,
            "if" | "elif" => condition::holds(self, &tokens(rest), at),
            _ => match &tokens(rest)[..] {
                [Token::Name(asked), ..] if name == "ifdef" => self.defined(asked, at),
                [Token::Name(asked), ..] => self.defined(asked, at).not(),
                _ => return None,
            },
        };
        let active = free.and(|| holds.clone());
        let taken = earlier.taken.or(|| holds);
        open.push((line, Branch { active, taken, last: name == "else" }));
        (open.len() <= MOST_DEPTH).then_some(())
    }

    fn directive(&mut self, name: &str, rest: &str, at: Place<'_>, active: Truth) -> Option<()> {
        let doubt = match active {
            Truth::No => return Some(()),
            Truth::Yes => None,
            Truth::Unknown(doubt) => Some(doubt),
        };
        let (file, line) = (at.file.to_owned(), at.line);
        match name {
            "define" => {
                let rest = rest.trim_start();
                let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
                let end = rest.find(|c: char| !is_part(c)).unwrap_or(rest.len());
                let (name, body) = rest.split_at(end);
                if !name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
                    return None;
                }
                let text = body.trim().to_owned();
                let body = match doubt {
                    Some(doubt) => Body::Depends(doubt),
                    None if body.starts_with('(') => Body::Function,
                    None => Body::Tokens(tokens(body)),
                };
                self.table.insert(name.to_owned(), Macro { file, line, text, body });
            }
            "undef" => {
                let name = rest.trim();
                match (doubt, self.table.get_mut(name)) {
                    (Some(doubt), Some(found)) => found.body = Body::Depends(doubt),
                    _ => drop(self.table.remove(name)),
                }
            }
            "include" => self.included.push((file, line, rest.trim().to_owned())),
            "error" if doubt.is_none() => self.errors.push((file, line, rest.trim().to_owned())),
            _ => {}
        }
        Some(())
    }

    /// A macro.
    pub fn get(&self, name: &str) -> Option<&Macro> {
        self.table.get(name)
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = (&String, &Macro)> {
        self.table.iter()
    }

    /// Whether a name is defined.
    pub fn defined(&self, name: &str, at: Place<'_>) -> Truth {
        match self.table.get(name) {
            Some(Macro { body: Body::Depends(doubt), .. }) => Truth::Unknown(doubt.clone()),
            Some(_) => Truth::Yes,
            None if self.options.contains(name) => Truth::No,
            None => Truth::Unknown(at.doubt(name)),
        }
    }

    /// Marlin's `ENABLED`: whether a name is defined as nothing, `1` or `true`.
    pub fn enabled(&self, name: &str, at: Place<'_>) -> Truth {
        let asked = vec![Token::Name(name.to_owned())];
        self.defined(name, at).and(|| match self.expand(&asked) {
            Ok(tokens) => Truth::of(match &tokens[..] {
                [] => true,
                [Token::Number(text)] => matches!(text.as_str(), "1" | "0x1"),
                [Token::Name(text)] => text == "true",
                _ => false,
            }),
            Err(Problem::Depends(doubt)) => Truth::Unknown(doubt),
            Err(Problem::TooLong) => Truth::Unknown(at.doubt(name)),
        })
    }

    /// Whether a name that nothing defines is an option that is switched off.
    pub fn is_option(&self, name: &str) -> bool {
        self.options.contains(name)
    }

    /// `tokens` with every macro replaced, again and again.
    pub fn expand(&self, tokens: &[Token]) -> Result<Vec<Token>, Problem> {
        let mut expanded = Vec::new();
        self.expand_into(tokens, &mut Vec::new(), &mut expanded)?;
        Ok(expanded)
    }

    fn expand_into<'a>(
        &'a self,
        tokens: &'a [Token],
        within: &mut Vec<&'a str>,
        out: &mut Vec<Token>,
    ) -> Result<(), Problem> {
        for token in tokens {
            self.count()?;
            let (name, found) = match token {
                Token::Name(name) if !within.contains(&name.as_str()) => {
                    (name, self.table.get(name))
                }
                _ => {
                    out.push(token.clone());
                    continue;
                }
            };
            match found.map(|found| &found.body) {
                Some(Body::Depends(doubt)) => return Err(Problem::Depends(doubt.clone())),
                Some(Body::Tokens(_)) if within.len() == MOST_DEPTH => {
                    return Err(Problem::TooLong)
                }
                Some(Body::Tokens(body)) => {
                    within.push(name);
                    self.expand_into(body, within, out)?;
                    within.pop();
                }
                Some(Body::Function) | None => out.push(token.clone()),
            }
        }
        Ok(())
    }

    /// Counts a token that is looked at.
    pub fn count(&self) -> Result<(), Problem> {
        self.expanded.set(self.expanded.get() + 1);
        match self.expanded.get() > MOST_TOKENS {
            true => Err(Problem::TooLong),
            false => Ok(()),
        }
    }
}

/// A line of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<'a> {
    /// The file.
    pub file: &'a str,
    /// The line.
    pub line: usize,
}

impl Place<'_> {
    /// That something here depends on `name`.
    pub fn doubt(&self, name: &str) -> Doubt {
        Doubt { name: name.to_owned(), file: self.file.to_owned(), line: self.line }
    }
}

/// The name that a line defines, or would if it were not commented out.
fn option(line: &str) -> Option<String> {
    let line = line.trim_start().trim_start_matches('/').trim_start();
    let rest = line.strip_prefix('#')?.trim_start().strip_prefix("define")?;
    let name = rest.strip_prefix([' ', '\t'])?.trim_start();
    let end = name.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(name.len());
    (end > 0).then(|| name[..end].to_owned())
}
