//! How much memory the machine still gives to this process.

/// Memory that can still be taken \[bytes\], and what bounds it.
#[derive(Debug, Clone, PartialEq)]
pub struct Available {
    /// How much \[bytes\].
    pub bytes: u64,
    /// Origin of the bound, as a phrase.
    pub by: &'static str,
}

/// The least of what Linux calls available, what the control groups of the process leave, and what its limit of addresses
/// (`ulimit -v`) leaves; `None` where the system does not say.
pub fn available() -> Option<Available> {
    let machine = || field(&read("/proc/meminfo")?, "MemAvailable:");
    let own = || field(&read("/proc/self/status")?, "VmSize:");
    let bounds = [
        ("the machine's free memory", machine()),
        ("the limit of the control group", control_group()),
        (
            "the limit of addresses (`ulimit -v`)",
            addresses().map(|most| most.saturating_sub(own().unwrap_or(0))),
        ),
    ];
    let known = bounds.into_iter().filter_map(|(by, bytes)| Some(Available { bytes: bytes?, by }));
    known.min_by_key(|available| available.bytes)
}

fn read(path: &str) -> Option<String> {
    std::fs::read_to_string(path).ok()
}

/// A field in kB of a file of /proc \[bytes\].
fn field(text: &str, name: &str) -> Option<u64> {
    let rest = text.lines().find_map(|line| line.strip_prefix(name))?;
    rest.split_whitespace().next()?.parse::<u64>().ok()?.checked_mul(1024)
}

/// Memory left by the control group of the process and those above it \[bytes\] (version 2: memory.max less memory.current; version 1: the same
/// by other names), file caches counted as free.
fn control_group() -> Option<u64> {
    let groups = read("/proc/self/cgroup")?;
    let folder = |line: &str| {
        let (controllers, path) = line.split_once(':')?.1.split_once(':')?;
        match controllers {
            "" => Some((format!("/sys/fs/cgroup{path}"), ["memory.max", "memory.current", "inactive_file "])),
            "memory" => Some((
                format!("/sys/fs/cgroup/memory{path}"),
                ["memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file "],
            )),
            _ => None,
        }
    };
    let mut least = None;
    for (path, [most, used, cached]) in groups.lines().filter_map(folder) {
        let mut folder = std::path::PathBuf::from(path);
        while folder.starts_with("/sys/fs/cgroup") {
            let number = |name: &str| read(folder.join(name).to_str()?)?.trim().parse::<u64>().ok();
            if let (Some(most), Some(used)) = (number(most), number(used)) {
                let stat = read(&folder.join("memory.stat").to_string_lossy()).unwrap_or_default();
                let cached =
                    stat.lines().find_map(|line| line.strip_prefix(cached)?.trim().parse::<u64>().ok());
                let left = most.saturating_sub(used.saturating_sub(cached.unwrap_or(0)));
                least = Some(least.map_or(left, |least: u64| least.min(left)));
            }
            folder.pop();
        }
    }
    least
}

/// The limit of addresses of this process \[bytes\].
#[cfg(unix)]
fn addresses() -> Option<u64> {
    let mut limit = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
    // SAFETY: the system writes into a structure of its own kind.
    let known = unsafe { libc::getrlimit(libc::RLIMIT_AS, &mut limit) } == 0;
    (known && limit.rlim_cur != libc::RLIM_INFINITY).then_some(limit.rlim_cur)
}

#[cfg(not(unix))]
fn addresses() -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_of_proc_are_in_bytes() {
        let text = "MemTotal:       100 kB\nMemAvailable:   20 kB\n";
        assert_eq!((field(text, "MemAvailable:"), field(text, "MemFree:")), (Some(20480), None));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn some_memory_is_there_and_less_than_the_machine_has() {
        let available = available().unwrap();
        let all = field(&read("/proc/meminfo").unwrap(), "MemTotal:").unwrap();
        assert!(available.bytes > 0 && available.bytes <= all, "{available:?} of {all}");
    }
}
