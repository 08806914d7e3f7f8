//! Embree's device: its configuration, its error reports, and the memory it says it uses.

use super::sys;
use crate::error::{Error, Result};
use crate::os::Isa;
use std::ffi::{CStr, CString, c_char, c_void};
use std::sync::Mutex;
use std::sync::atomic::{AtomicIsize, Ordering};

/// What Embree's callbacks write to; boxed, so that its address stays.
#[derive(Default)]
struct Reports {
    bytes: AtomicIsize,
    /// The first error since the last check.
    error: Mutex<Option<String>>,
}

/// An owned Embree device.
pub(super) struct Device {
    handle: sys::RTCDevice,
    reports: Box<Reports>,
}

// SAFETY: Embree documents its API as thread safe for devices; the reports are atomics and a mutex.
unsafe impl Send for Device {}
// SAFETY: as above; shared use only reads properties.
unsafe impl Sync for Device {}

impl Device {
    /// A device that builds with at most `threads` threads (0: all), and uses no wider instructions than
    /// those of `isa`, if that is less than the machine has.
    pub(super) fn new(threads: usize, isa: Isa) -> Result<Self> {
        let limit = match isa {
            _ if isa >= Isa::detect() => "",
            Isa::Portable => ",isa=sse2",
            Isa::Avx2 => ",isa=avx2",
            Isa::Avx512 => ",isa=avx512",
        };
        let config = CString::new(format!("threads={threads}{limit}")).unwrap_or_default();
        // SAFETY: the string is valid for the call, which copies it.
        let handle = unsafe { sys::rtcNewDevice(config.as_ptr()) };
        if handle.is_null() {
            // SAFETY: a null device is documented to return the error of device creation.
            let code = unsafe { sys::rtcGetDeviceError(std::ptr::null_mut()) };
            return Err(failure(format!("no device: {}", error_name(code))));
        }
        let device = Self { handle, reports: Box::default() };
        let user = std::ptr::from_ref::<Reports>(&device.reports).cast_mut().cast::<c_void>();
        // SAFETY: `user` points to the boxed reports, which live until the device is released in drop.
        unsafe { sys::rtcSetDeviceErrorFunction(handle, Some(on_error), user) };
        // SAFETY: as above.
        unsafe { sys::rtcSetDeviceMemoryMonitorFunction(handle, Some(on_memory), user) };
        Ok(device)
    }

    /// The raw handle, valid as long as `self`.
    pub(super) fn handle(&self) -> sys::RTCDevice {
        self.handle
    }

    /// Bytes that Embree holds now.
    pub(super) fn bytes(&self) -> usize {
        usize::try_from(self.reports.bytes.load(Ordering::Relaxed)).unwrap_or(0)
    }

    /// The error that Embree reported since the last check, if any.
    pub(super) fn check(&self) -> Result<()> {
        let message = self.reports.error.lock().ok().and_then(|mut error| error.take());
        message.map_or(Ok(()), |message| Err(failure(message)))
    }

    /// A property that exists in Embree 3 and 4.
    fn property(&self, property: sys::RTCDeviceProperty) -> isize {
        // SAFETY: the handle is valid.
        unsafe { sys::rtcGetDeviceProperty(self.handle, property) }
    }

    /// Version of the linked library.
    pub(super) fn version(&self) -> String {
        let property = |p| self.property(p);
        format!(
            "{}.{}.{}",
            property(sys::RTCDeviceProperty::RTC_DEVICE_PROPERTY_VERSION_MAJOR),
            property(sys::RTCDeviceProperty::RTC_DEVICE_PROPERTY_VERSION_MINOR),
            property(sys::RTCDeviceProperty::RTC_DEVICE_PROPERTY_VERSION_PATCH)
        )
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: the handle is owned and released once; scenes hold their own references to it.
        unsafe { sys::rtcReleaseDevice(self.handle) };
    }
}

fn failure(message: String) -> Error {
    Error::Backend { backend: "embree", message }
}

fn error_name(code: sys::RTCError) -> &'static str {
    match code {
        sys::RTCError::RTC_ERROR_NONE => "no error",
        sys::RTCError::RTC_ERROR_INVALID_ARGUMENT => "invalid argument",
        sys::RTCError::RTC_ERROR_INVALID_OPERATION => "invalid operation",
        sys::RTCError::RTC_ERROR_OUT_OF_MEMORY => "out of memory",
        sys::RTCError::RTC_ERROR_UNSUPPORTED_CPU => "this CPU is not supported (SSE2 at least)",
        sys::RTCError::RTC_ERROR_CANCELLED => "cancelled",
        _ => "unknown error",
    }
}

/// Keeps the first message until it is asked for. `extern "C"` aborts on unwind.
unsafe extern "C" fn on_error(user: *mut c_void, code: sys::RTCError, text: *const c_char) {
    // SAFETY: Embree hands back the pointer to the device's boxed reports.
    let reports = unsafe { &*user.cast_const().cast::<Reports>() };
    let detail = if text.is_null() {
        String::new()
    } else {
        // SAFETY: Embree passes a terminated string that lives for the call.
        unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
    };
    if let Ok(mut error) = reports.error.lock() {
        error.get_or_insert_with(|| format!("{}: {detail}", error_name(code)));
    }
}

/// Counts allocations (positive) and releases (negative); lets every allocation proceed.
unsafe extern "C" fn on_memory(user: *mut c_void, bytes: isize, _post: bool) -> bool {
    // SAFETY: Embree hands back the pointer to the device's boxed reports.
    let reports = unsafe { &*user.cast_const().cast::<Reports>() };
    reports.bytes.fetch_add(bytes, Ordering::Relaxed);
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instruction_sets_can_be_limited() {
        // Packets of 16 rays are native to AVX-512 alone, packets of 8 to AVX and more.
        for (name, isa) in Isa::ALL {
            let device = Device::new(1, isa).expect("embree is there");
            let native = |p| device.property(p) != 0;
            let isa = isa.min(Isa::detect());
            let eight = native(sys::RTCDeviceProperty::RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED);
            let sixteen =
                native(sys::RTCDeviceProperty::RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED);
            assert_eq!((eight, sixteen), (isa >= Isa::Avx2, isa >= Isa::Avx512), "{name}");
        }
    }

    #[test]
    fn embrees_own_error_becomes_ours() {
        let device = Device::new(1, Isa::Avx512).expect("embree is there");
        device.check().expect("no error yet");
        // SAFETY: an unknown geometry type is refused with an error report and a null handle.
        let refused = unsafe { sys::rtcNewGeometry(device.handle(), sys::RTCGeometryType(9999)) };
        assert!(refused.is_null());
        let message = device.check().expect_err("embree objects").to_string();
        assert!(message.starts_with("embree: "), "{message}");
        assert!(message.len() > "embree: unknown error: ".len(), "{message}");
        device.check().expect("an error is reported once");
    }
}
