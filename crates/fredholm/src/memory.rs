//! How much memory there is, and how much was used: what Linux says under /proc.

use std::fs;

/// The share of the memory that is free which a matrix may take: what is made of it and the rest of the machine need some too.
const SHARE: f64 = 0.8;

/// The most bytes that a matrix may take, four fifths of what is free now; `u64::MAX` where the system does not say.
pub fn limit() -> u64 {
    read("/proc/meminfo", "MemAvailable:").map_or(u64::MAX, |bytes| (bytes as f64 * SHARE) as u64)
}

/// The most bytes that this process has had in memory at once, where the system says.
pub fn peak() -> Option<u64> {
    read("/proc/self/status", "VmHWM:")
}

fn read(file: &str, key: &str) -> Option<u64> {
    kilobytes(&fs::read_to_string(file).ok()?, key)
}

/// The bytes of a line such as `VmHWM:   1234 kB`.
fn kilobytes(text: &str, key: &str) -> Option<u64> {
    let value = text.lines().find_map(|line| line.strip_prefix(key))?;
    let number: u64 = value.trim().strip_suffix("kB")?.trim().parse().ok()?;
    number.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_proc_is_read_in_bytes() {
        let text = "VmPeak:\t  99 kB\nVmHWM:\t   1234 kB\nThreads:\t1\n";
        assert_eq!(kilobytes(text, "VmHWM:"), Some(1234 * 1024));
        assert_eq!(kilobytes(text, "Threads:"), None);
        assert_eq!(kilobytes(text, "Missing:"), None);
    }
}
