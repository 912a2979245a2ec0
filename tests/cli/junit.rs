//! JUnit reports: well-formed XML 1.0, and valid by the rules that the schemas of Maven Surefire and
//! of Jenkins' xUnit plugin have in common.

use std::iter::Peekable;
use std::str::Chars;

/// An element as a reader of XML sees it.
#[derive(Debug, Default)]
pub struct Element {
    pub name: String,
    pub attributes: Vec<(String, String)>,
    pub children: Vec<Element>,
    pub text: String,
}

impl Element {
    pub fn attribute(&self, name: &str) -> &str {
        let found = self.attributes.iter().find(|(known, _)| known == name);
        &found.unwrap_or_else(|| panic!("no {name} in {self:?}")).1
    }

    pub fn child(&self, name: &str) -> Option<&Element> {
        self.children.iter().find(|child| child.name == name)
    }
}

/// The root of a document that is one element after the declaration.
pub fn read(document: &str) -> Element {
    let body = document.strip_prefix("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n").unwrap();
    assert!(document.chars().all(admissible), "a character that XML does not have");
    let mut reader = Reader(body.trim_end().chars().peekable());
    reader.expect('<');
    let root = reader.element();
    assert_eq!(reader.0.next(), None, "text after the root");
    root
}

/// `Char` of XML 1.0.
fn admissible(c: char) -> bool {
    matches!(c, '\t' | '\n' | '\r' | ' '..='\u{fffd}' | '\u{10000}'..)
}

struct Reader<'a>(Peekable<Chars<'a>>);

impl Reader<'_> {
    fn expect(&mut self, c: char) {
        assert_eq!(self.0.next(), Some(c));
    }

    fn name(&mut self) -> String {
        let mut name = String::new();
        while let Some(c) = self.0.next_if(|c| c.is_ascii_alphanumeric() || *c == '-') {
            name.push(c);
        }
        assert!(!name.is_empty());
        name
    }

    /// Characters up to `end`, references resolved.
    fn text(&mut self, end: char) -> String {
        let mut text = String::new();
        while let Some(c) = self.0.next_if(|c| *c != end) {
            assert_ne!(c, '<');
            text.push(if c == '&' { self.reference() } else { c });
        }
        text
    }

    fn reference(&mut self) -> char {
        let name: String = self.0.by_ref().take_while(|c| *c != ';').collect();
        match name.as_str() {
            "amp" => '&',
            "lt" => '<',
            "gt" => '>',
            "quot" => '"',
            number => {
                let code = number.strip_prefix('#').unwrap().parse().unwrap();
                char::from_u32(code).filter(|c| admissible(*c)).unwrap()
            }
        }
    }

    /// What follows `<`.
    fn element(&mut self) -> Element {
        let mut element = Element { name: self.name(), ..Element::default() };
        loop {
            match self.0.next() {
                Some(' ') => {
                    let name = self.name();
                    assert!(element.attributes.iter().all(|(known, _)| *known != name));
                    self.expect('=');
                    self.expect('"');
                    element.attributes.push((name, self.text('"')));
                    self.expect('"');
                }
                Some('/') => {
                    self.expect('>');
                    return element;
                }
                Some('>') => break,
                other => panic!("{other:?} in a tag"),
            }
        }
        loop {
            element.text += &self.text('<');
            self.expect('<');
            if self.0.next_if_eq(&'/').is_some() {
                assert_eq!(self.name(), element.name);
                self.expect('>');
                return element;
            }
            element.children.push(self.element());
        }
    }
}

/// An element's required attributes, and its children in their order.
const RULES: [(&str, &[&str], &[&str]); 6] = [
    (
        "testsuite",
        &["name", "time", "tests", "errors", "skipped", "failures"],
        &["properties", "testcase"],
    ),
    (
        "testcase",
        &["name", "classname", "time"],
        &["failure", "skipped", "error", "system-out", "system-err"],
    ),
    ("failure", &["message", "type"], &[]),
    ("error", &["message", "type"], &[]),
    ("skipped", &["message"], &[]),
    ("system-out", &[], &[]),
];

/// Holds the rules of every element, and that the suite's counts are those of its cases.
pub fn valid(root: &Element) {
    assert_eq!(root.name, "testsuite");
    rules(root);
    for (count, element) in [("failures", "failure"), ("errors", "error"), ("skipped", "skipped")] {
        let cases = root.children.iter().filter(|case| case.child(element).is_some()).count();
        assert_eq!(root.attribute(count), cases.to_string());
    }
    assert_eq!(root.attribute("tests"), root.children.len().to_string());
}

fn rules(element: &Element) {
    let rule = RULES.iter().find(|(name, _, _)| *name == element.name);
    let (_, attributes, children) = rule.unwrap_or_else(|| panic!("unknown {element:?}"));
    let mut names: Vec<&str> = element.attributes.iter().map(|(name, _)| name.as_str()).collect();
    names.sort_unstable();
    let mut expected = attributes.to_vec();
    expected.sort_unstable();
    assert_eq!(names, expected);
    if attributes.contains(&"time") {
        let (whole, part) = element.attribute("time").split_once('.').unwrap();
        assert!(part.len() <= 3 && format!("{whole}{part}").bytes().all(|b| b.is_ascii_digit()));
    }
    let order = |child: &Element| children.iter().position(|name| *name == child.name);
    let orders: Vec<usize> = element.children.iter().map(|child| order(child).unwrap()).collect();
    assert!(orders.is_sorted());
    if !element.children.is_empty() {
        assert_eq!(element.text.trim(), "", "text between elements");
    }
    element.children.iter().for_each(rules);
}
