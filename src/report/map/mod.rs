//! The map of an atlas, drawn.
//!
//! | module     | does                                  |
//! |------------|---------------------------------------|
//! | `contours` | lines of equal margin, by sampling    |
//! | `picture`  | the map as SVG                        |
//! | `page`     | the picture on an HTML page           |

mod contours;
mod page;
mod picture;

pub use contours::{contours, Contour};
pub use page::page;
pub use picture::{picture, Point};
