//! Checks of the kernel, its limits and its cores, from files in /proc and /sys.

use super::finding::{Finding, Rating, lacking};
use std::fs::read_to_string;
use std::path::Path;
use sun2xp::model::configuration::Configuration;

/// Memory that three servo threads lock, bytes: at most 3.3 MiB for stacks, mailboxes and events, and a reserve. The
/// reserve is for the copy of the planner's thread-local variables that each stack contains.
const LOCKED: u64 = 4 << 20;

/// Memory that the three servo threads also lock for each Hz of the rate, with a reserve, bytes. Their rings hold the
/// records of 0.5 s and the timings of 0.8 s, which are 1750 bytes for each Hz.
const LOCKED_PER_HZ: f64 = 2048.0;

const CAP_IPC_LOCK: u32 = 14;
const CAP_SYS_NICE: u32 = 23;

/// The limits file that docs/real-time.md recommends.
const LIMITS: &str = "/etc/security/limits.d/sun2xp.conf";

pub(super) fn findings(configuration: &Configuration, root: &Path) -> Vec<Finding> {
    let read = |path: &str| read_to_string(root.join(path)).unwrap_or_default();
    let (limits, status) = (read("proc/self/limits"), read("proc/self/status"));
    let isolated = read("sys/devices/system/cpu/isolated");
    let mut findings = vec![
        kernel(&read("proc/version"), read("sys/kernel/realtime").trim() == "1"),
        throttling(
            read("proc/sys/kernel/sched_rt_runtime_us").trim(),
            read("proc/sys/kernel/sched_rt_period_us").trim(),
        ),
        scheduling(configuration, limit(&limits, "Max realtime priority"), has(&status, CAP_SYS_NICE)),
        memory(configuration, limit(&limits, "Max locked memory"), has(&status, CAP_IPC_LOCK)),
        cores(configuration, &listed(field(&status, "Cpus_allowed_list:")), &listed(&isolated)),
    ];
    let online = listed(&read("sys/devices/system/cpu/online"));
    findings.push(governor(&online, |core| {
        read_to_string(root.join(format!("sys/devices/system/cpu/cpu{core}/cpufreq/scaling_governor"))).ok()
    }));
    findings
}

fn kernel(version: &str, realtime: bool) -> Finding {
    let release = version.split(' ').nth(2).unwrap_or("of unknown release");
    if realtime || version.contains("PREEMPT_RT") {
        return Finding::good("kernel", format!("Linux {release}, PREEMPT_RT"));
    }
    let advice = "An ordinary kernel usually wakes threads up in time, but its worst wake-up latency has no bound. \
                  Install a PREEMPT_RT kernel (Debian: apt install linux-image-rt-amd64, or linux-image-rt-arm64) and \
                  boot it";
    Finding::new(Rating::Warning, "kernel", format!("Linux {release}, without PREEMPT_RT"), advice)
}

/// `runtime` us of every `period` us are available to real-time threads.
fn throttling(runtime: &str, period: &str) -> Finding {
    let subject = "real-time throttling";
    let period = period.parse::<i64>().ok().filter(|&period| period > 0);
    // The kernel's default is 95 % of the period.
    let usual = period.unwrap_or(1_000_000) / 20 * 19;
    let remedy = format!("sudo sysctl kernel.sched_rt_runtime_us={usual}");
    match (runtime.parse::<i64>(), period) {
        (Ok(-1), _) => Finding::new(
            Rating::Warning,
            subject,
            "off",
            format!(
                "A real-time thread that never sleeps would block its core permanently, also for the threads of the \
                 kernel that serve the ports. Switch the throttling on: {remedy}"
            ),
        ),
        (Ok(runtime), Some(period)) => {
            let share = 100 * runtime / period;
            let found = format!("real-time threads get {share} % of the time, {runtime} of {period} us");
            match share {
                _ if runtime == 0 => Finding::new(
                    Rating::Failure,
                    subject,
                    found,
                    format!("Real-time threads get no time at all. Change that: {remedy}"),
                ),
                ..50 => Finding::new(
                    Rating::Warning,
                    subject,
                    found,
                    format!("The servos may be stopped in the middle of a period. Change that: {remedy}"),
                ),
                _ => Finding::good(subject, found),
            }
        }
        _ => Finding::good(subject, "this kernel has none"),
    }
}

fn scheduling(configuration: &Configuration, limit: Option<u64>, capable: bool) -> Finding {
    let subject = "real-time priority";
    let wanted = configuration.of_hand().map(|finger| finger.priority).max().unwrap_or(0);
    if wanted == 0 {
        let advice = "The servos have the jitter of ordinary threads: set finger.priority to 80, and hand.real_time to \
                      \"try\" if it is \"ignore\"";
        return Finding::new(Rating::Warning, subject, "finger.priority is 0", advice);
    }
    // `None` means unlimited.
    if capable || limit.is_none_or(|limit| limit >= wanted.into()) {
        let by = match limit {
            _ if capable => "CAP_SYS_NICE".into(),
            Some(limit) => format!("the rtprio limit {limit}"),
            None => "the rtprio limit, which is unlimited".into(),
        };
        return Finding::good(subject, format!("{wanted} is permitted by {by}"));
    }
    let permitted = wanted.max(90);
    let advice = format!(
        "The servos would have the jitter of ordinary threads. Write `@realtime - rtprio {permitted}` into {LIMITS}, \
         join the group (sudo groupadd -f realtime; sudo usermod -aG realtime $USER) and log in again"
    );
    lacking(
        configuration,
        subject,
        format!("{wanted} is configured, but the rtprio limit is {}", limit.unwrap_or(0)),
        advice,
    )
}

fn memory(configuration: &Configuration, limit: Option<u64>, capable: bool) -> Finding {
    let subject = "locked memory";
    let needed = LOCKED + (LOCKED_PER_HZ * configuration.hand.rate).ceil() as u64;
    // `None` means unlimited.
    if capable || limit.is_none_or(|limit| limit >= needed) {
        let by = if capable { "CAP_IPC_LOCK" } else { "the memlock limit" };
        return Finding::good(subject, format!("permitted by {by}"));
    }
    let kilobytes = limit.unwrap_or(0) / 1024;
    let advice = format!(
        "When memory is short, a servo may have to wait for its own pages. Write `@realtime - memlock unlimited` into \
         {LIMITS}, join the group (sudo groupadd -f realtime; sudo usermod -aG realtime $USER) and log in again"
    );
    let found = format!("the memlock limit is {kilobytes} kB, but the servos need {} kB with a reserve", needed / 1024);
    lacking(configuration, subject, found, advice)
}

fn cores(configuration: &Configuration, allowed: &[usize], isolated: &[usize]) -> Finding {
    let subject = "cores";
    let mut wanted: Vec<usize> = configuration.of_hand().filter_map(|finger| finger.core).collect();
    wanted.sort_unstable();
    wanted.dedup();
    let configured = if wanted.is_empty() { "none, so the scheduler selects them".into() } else { numbers(&wanted) };
    let found = format!("configured: {configured}; permitted: {}; isolated: {}", numbers(allowed), numbers(isolated));
    if let Some(core) = wanted.iter().find(|core| !allowed.contains(core)) {
        let advice = format!(
            "The servo cannot run on core {core}: set finger.core to a permitted core (taskset -cp $$ lists them)"
        );
        return lacking(configuration, subject, found, advice);
    }
    if let Some(core) = wanted.iter().find(|core| !isolated.contains(core)) {
        let cores: Vec<_> = wanted.iter().map(usize::to_string).collect();
        let advice = format!(
            "Other programs run on core {core} too and delay the servo: boot with isolcpus={0} nohz_full={0}",
            cores.join(",")
        );
        return Finding::new(Rating::Warning, subject, found, advice);
    }
    if wanted.is_empty() && !isolated.is_empty() {
        let advice = "No servo uses the isolated cores: set finger.core to one of them";
        return Finding::new(Rating::Warning, subject, found, advice);
    }
    Finding::good(subject, found)
}

/// The numbers of cores as text.
fn numbers(cores: &[usize]) -> String {
    let list = cores.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
    if list.is_empty() { "none".into() } else { list }
}

fn governor(online: &[usize], read: impl Fn(usize) -> Option<String>) -> Finding {
    let subject = "frequency governor";
    let slow = online.iter().find_map(|&core| {
        let governor = read(core)?.trim().to_string();
        (governor != "performance").then_some((core, governor))
    });
    match slow {
        Some((core, governor)) => {
            let advice = "A core at a low frequency wakes up late. Select a high frequency: sudo cpupower \
                          frequency-set -g performance";
            Finding::new(Rating::Warning, subject, format!("{governor} on core {core}"), advice)
        }
        None if online.iter().any(|&core| read(core).is_some()) => Finding::good(subject, "performance"),
        None => Finding::good(subject, "none: the hypervisor or the firmware decides"),
    }
}

/// The soft limit in a line of /proc/self/limits; `None` if it is unlimited, and 0 if the line is missing.
fn limit(limits: &str, name: &str) -> Option<u64> {
    match field(limits, name).split_whitespace().next() {
        Some("unlimited") => None,
        number => Some(number.and_then(|number| number.parse().ok()).unwrap_or(0)),
    }
}

/// Whether /proc/self/status lists an effective capability.
fn has(status: &str, capability: u32) -> bool {
    u64::from_str_radix(field(status, "CapEff:"), 16).is_ok_and(|bits| bits & 1 << capability != 0)
}

/// The rest of the line that begins with `name`.
fn field<'a>(text: &'a str, name: &str) -> &'a str {
    text.lines().find_map(|line| line.strip_prefix(name)).unwrap_or("").trim()
}

/// Parses the kernel's lists of cores, such as `0-2,5`.
fn listed(list: &str) -> Vec<usize> {
    let range = |part: &str| {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        Some(first.parse::<usize>().ok()?..=last.parse::<usize>().ok()?)
    };
    list.trim().split(',').filter_map(range).flatten().collect()
}

#[cfg(test)]
mod tests;
