//! The sampling laboratory: point sets measured and drawn, the zone plate, stippling. Knows the strategies and no scene.

pub mod zone_plate;
