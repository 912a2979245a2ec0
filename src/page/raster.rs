//! Figures as PNG: drawn without a browser, their text as outlines of a font of the system.

use super::svg::Picture;
use orthocert_checker::file;
use orthocert_checker::shown::Named;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use std::fmt;
use std::path::{Path, PathBuf};
use ttf_parser::{Face, OutlineBuilder};

/// Pixels for a figure's unit: about 300 to the inch at a width of two columns.
const SCALE: f32 = 3.0;
/// Where systems keep the fonts that have every sign of the figures: regular and bold.
const KNOWN: [[&str; 2]; 7] = [
    [
        "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
        "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf",
    ],
    ["/usr/share/fonts/TTF/DejaVuSans.ttf", "/usr/share/fonts/TTF/DejaVuSans-Bold.ttf"],
    [
        "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
        "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans-Bold.ttf",
    ],
    [
        "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
        "/usr/share/fonts/truetype/liberation/LiberationSans-Bold.ttf",
    ],
    [
        "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
        "/usr/share/fonts/truetype/noto/NotoSans-Bold.ttf",
    ],
    [
        "/System/Library/Fonts/Supplemental/Arial.ttf",
        "/System/Library/Fonts/Supplemental/Arial Bold.ttf",
    ],
    ["C:\\Windows\\Fonts\\arial.ttf", "C:\\Windows\\Fonts\\arialbd.ttf"],
];

/// The fonts that text is drawn in.
#[derive(Debug)]
pub struct Fonts {
    regular: Vec<u8>,
    bold: Vec<u8>,
}

/// Most bytes of a font.
const MAX_FONT: u64 = 64 << 20;

/// Why there is no font.
#[derive(Debug)]
#[non_exhaustive]
pub enum FontError {
    /// The file cannot be read as a font.
    NotAFont(PathBuf),
    /// The system has none of those that are known.
    NoneFound,
}

impl fmt::Display for FontError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FontError::NotAFont(path) => {
                write!(f, "--font: {} is not a TrueType or OpenType font", path.shown())
            }
            FontError::NoneFound => write!(
                f,
                "--png: the text needs a font, and none of DejaVu Sans, Liberation Sans, Noto Sans \
                 and Arial was found; accepted: --font FILE.ttf, or --svg, which needs none"
            ),
        }
    }
}

impl std::error::Error for FontError {}

impl Fonts {
    /// The font that was asked for, or one of the system's.
    ///
    /// # Errors
    /// [`FontError`].
    pub fn find(asked: Option<&Path>) -> Result<Self, FontError> {
        let readable = |path: &Path| {
            let bytes = file::read(path, MAX_FONT).ok()?;
            Face::parse(&bytes, 0).is_ok().then_some(bytes)
        };
        if let Some(path) = asked {
            let regular = readable(path).ok_or_else(|| FontError::NotAFont(path.to_owned()))?;
            return Ok(Fonts { bold: regular.clone(), regular });
        }
        let known = KNOWN.iter().find_map(|[regular, bold]| {
            let regular = readable(Path::new(regular))?;
            let bold = readable(Path::new(bold)).unwrap_or_else(|| regular.clone());
            Some(Fonts { regular, bold })
        });
        known.ok_or(FontError::NoneFound)
    }
}

/// The picture as a PNG file.
///
/// # Errors
/// A sentence, if the picture cannot be drawn.
pub fn png(picture: &Picture, fonts: &Fonts) -> Result<Vec<u8>, String> {
    let fail = |what: &str| format!("{}.png: cannot be drawn: {what}", picture.name);
    let face = |bytes| Face::parse(bytes, 0).map_err(|error| fail(&error.to_string()));
    let faces = [face(&fonts.regular)?, face(&fonts.bold)?];
    let svg = outlined(&picture.file(), &faces);
    let tree = Tree::from_str(&svg, &Options::default()).map_err(|e| fail(&e.to_string()))?;
    let pixels = |size: f64| (size as f32 * SCALE).round() as u32;
    let [width, height] = picture.size.map(pixels);
    let mut map = Pixmap::new(width, height).ok_or_else(|| fail("no room"))?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut map.as_mut());
    map.encode_png().map_err(|error| fail(&error.to_string()))
}

/// The text of a figure, by its class: size in units, whether bold, and where it is anchored.
fn measures(class: &str) -> (f32, bool, f32) {
    let has = |name: &str| class.split(' ').any(|c| c == name);
    let size = match () {
        () if has("level-label") => 10.0,
        () if has("tick") => 10.5,
        () if has("leg-label") || has("mark-label") => 12.0,
        () if has("label") || has("map-title") => 13.0,
        () => 12.0,
    };
    let anchor = match () {
        () if has("middle") || has("level-label") => 0.5,
        () if has("end") => 1.0,
        () => 0.0,
    };
    (size, has("map-title") || has("mark-label"), anchor)
}

/// The figure with every `text` element as a path of its glyphs.
fn outlined(svg: &str, faces: &[Face<'_>; 2]) -> String {
    let mut out = String::with_capacity(svg.len());
    let mut rest = svg;
    while let Some((before, after)) = rest.split_once("<text ") {
        out.push_str(before);
        let Some((element, after)) = after.split_once("</text>") else {
            break;
        };
        let (attributes, text) = element.split_once('>').unwrap_or((element, ""));
        let attribute = |name: &str| {
            let (_, value) = attributes.split_once(&format!("{name}=\""))?;
            value.split_once('"').map(|(value, _)| value)
        };
        let number = |name: &str| attribute(name).and_then(|x| x.parse().ok()).unwrap_or(0.0);
        let class = attribute("class").unwrap_or("");
        let (size, bold, anchor) = measures(class);
        let face = &faces[usize::from(bold)];
        let d = glyphs(face, &plain(text), [number(" x"), number(" y")], size, anchor);
        out.push_str(&format!("<path class=\"outlined {class}\" d=\"{d}\"/>"));
        rest = after;
    }
    out.push_str(rest);
    // What styles text styles its outlines; text not styled otherwise is in ink.
    out.replace("<style>", "<style>\n.figure .outlined { fill: #1b2330; }\n")
}

/// The text that [`crate::escape::xml`] has escaped.
fn plain(text: &str) -> String {
    let text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"");
    text.replace("&#39;", "'").replace("&amp;", "&")
}

/// The outlines of a text, anchored at a part of its width.
fn glyphs(face: &Face<'_>, text: &str, [x, y]: [f32; 2], size: f32, anchor: f32) -> String {
    let scale = size / f32::from(face.units_per_em());
    let ids: Vec<_> = text.chars().map(|c| face.glyph_index(c).unwrap_or_default()).collect();
    let advance = |id| scale * f32::from(face.glyph_hor_advance(id).unwrap_or(0));
    let width: f32 = ids.iter().map(|id| advance(*id)).sum();
    let mut pen = Pen { d: String::new(), x: x - anchor * width, y, scale };
    for id in ids {
        face.outline_glyph(id, &mut pen);
        pen.x += advance(id);
    }
    pen.d
}

/// Writes outlines as the data of a path.
struct Pen {
    d: String,
    x: f32,
    y: f32,
    scale: f32,
}

impl Pen {
    fn add(&mut self, command: char, points: &[(f32, f32)]) {
        self.d.push(command);
        for (x, y) in points {
            let (x, y) = (self.x + self.scale * x, self.y - self.scale * y);
            self.d.push_str(&format!("{x:.2} {y:.2} "));
        }
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.add('M', &[(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.add('L', &[(x, y)]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.add('Q', &[(x1, y1), (x, y)]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.add('C', &[(x1, y1), (x2, y2), (x, y)]);
    }

    fn close(&mut self) {
        self.d.push('Z');
    }
}
