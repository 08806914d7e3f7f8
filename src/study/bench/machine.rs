//! The machine that a bench ran on, in the words that make its figures comparable.

use super::result::Machine;
use crate::error::Result;
use std::time::SystemTime;

impl Machine {
    /// This one, now.
    ///
    /// # Errors
    /// Where Embree is built in but does not run here.
    pub(super) fn here() -> Result<Self> {
        #[cfg(feature = "embree")]
        let embree = Some(crate::accel::embree::version()?);
        #[cfg(not(feature = "embree"))]
        let embree = None;
        let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
        Ok(Self { cpu: cpu_name(), threads: most_threads(), date: now, embree })
    }
}

/// Threads that the machine runs at once.
pub fn most_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// The processor by its own name, or by its architecture where the system does not tell.
fn cpu_name() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().filter_map(|line| line.split_once(':'));
    let name = model.filter(|(key, _)| key.trim() == "model name").map(|(_, name)| name.trim());
    name.map(str::to_owned).next().unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}
