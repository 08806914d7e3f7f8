//! The sampling laboratory: point sets measured and drawn, the zone plate, stippling. Knows the strategies and no scene.

pub mod exhibit;
pub mod listing;
pub mod measure;
pub mod picture;
pub mod stipple;
pub mod zone_plate;
