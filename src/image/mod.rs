//! Images: decoded pictures for textures and environments, and files written for the user.

/// A decoded picture (to be completed by the image module).
#[derive(Clone, Debug, Default)]
pub struct Image {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}
