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

/// System, processor and cores in a few words.
pub(super) fn about() -> String {
    let model = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model =
        model.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':')).map(|(_, name)| name.trim());
    let model = model.map_or_else(|| std::env::consts::ARCH.to_string(), ToString::to_string);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{} on {model}, {cores} cores", std::env::consts::OS)
}
