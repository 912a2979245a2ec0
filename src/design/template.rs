//! Commented design files to start from.

/// The templates by name, the usual one first.
pub const TEMPLATES: &[(&str, &str)] = &[
    ("orthoglide", include_str!("templates/orthoglide.toml")),
    ("orthoglide-cube", include_str!("templates/orthoglide-cube.toml")),
    ("translational", include_str!("templates/translational.toml")),
    ("linear-delta", include_str!("templates/linear-delta.toml")),
    ("rotary-delta", include_str!("templates/rotary-delta.toml")),
    ("strut", include_str!("templates/strut.toml")),
    ("tripteron", include_str!("templates/tripteron.toml")),
    ("formulas", include_str!("templates/formulas.toml")),
    ("planar", include_str!("templates/planar.toml")),
    ("spatial", include_str!("templates/spatial.toml")),
    ("spherical", include_str!("templates/spherical.toml")),
];

/// Other names that people look for, with those of their templates.
pub const OTHER_NAMES: &[(&str, &str)] = &[("hexapod", "spatial"), ("delta", "linear-delta")];

/// The template called `kind`, one of [`TEMPLATES`] or [`OTHER_NAMES`].
pub fn template(kind: &str) -> Option<&'static str> {
    let other = OTHER_NAMES.iter().find(|(name, _)| *name == kind);
    let kind = other.map_or(kind, |(_, template)| template);
    TEMPLATES.iter().find(|(name, _)| *name == kind).map(|(_, text)| *text)
}
