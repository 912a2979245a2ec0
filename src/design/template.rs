//! Commented design files to start from.

/// The templates by name, the usual one first.
pub const TEMPLATES: &[(&str, &str)] = &[
    ("orthoglide", include_str!("templates/orthoglide.toml")),
    ("orthoglide-cube", include_str!("templates/orthoglide-cube.toml")),
    ("translational", include_str!("templates/translational.toml")),
];

/// The template called `kind`, one of [`TEMPLATES`].
pub fn template(kind: &str) -> Option<&'static str> {
    TEMPLATES.iter().find(|(name, _)| *name == kind).map(|(_, text)| *text)
}
