//! What the operating system says of memory; nothing where it does not.

use std::fs;

/// The most memory this process had at one time, in bytes.
pub(super) fn peak_memory() -> Option<u64> {
    field("/proc/self/status", "VmHWM:")
}

/// Memory that can be had without swapping, in bytes.
pub(super) fn available_memory() -> Option<u64> {
    field("/proc/meminfo", "MemAvailable:")
}

/// A field, in kB, of a file that the kernel writes.
fn field(file: &str, name: &str) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kilobytes.checked_mul(1024)
}
