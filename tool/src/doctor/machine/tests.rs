//! Findings of machines whose files in /proc and /sys are made up.

use super::*;
use std::{fs, io};
use sun2xp::hand::MissingPermission;
use sun2xp::model::configuration::{RATES, RealTime};
use tempfile::TempDir;

/// Files of a machine that passes every check.
const GOOD: [(&str, &str); 9] = [
    ("proc/version", "Linux version 6.1.0-18-rt-amd64 (debian) #1 SMP PREEMPT_RT Debian 6.1.76-1\n"),
    ("proc/sys/kernel/sched_rt_runtime_us", "950000\n"),
    ("proc/sys/kernel/sched_rt_period_us", "1000000\n"),
    (
        "proc/self/limits",
        "Limit  Soft Limit  Hard Limit  Units\nMax locked memory   unlimited  unlimited  bytes\nMax realtime \
         priority  90  90\n",
    ),
    ("proc/self/status", "Name:\tx\nCapEff:\t0000000000000000\nCpus_allowed_list:\t0-3\n"),
    ("sys/devices/system/cpu/isolated", "2-3\n"),
    ("sys/devices/system/cpu/online", "0-3\n"),
    ("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance\n"),
    ("sys/devices/system/cpu/cpu3/cpufreq/scaling_governor", "performance\n"),
];

/// The findings if one file of a good machine differs.
fn found(path: &str, text: &str, change: impl FnOnce(&mut Configuration)) -> Vec<Finding> {
    let root = TempDir::new().expect("a folder");
    for (file, text) in GOOD.into_iter().chain([(path, text)]) {
        let file = root.path().join(file);
        fs::create_dir_all(file.parent().expect("a folder")).expect("made");
        fs::write(file, text).expect("written");
    }
    let mut configuration = Configuration::default();
    configuration.fingers.iter_mut().for_each(|finger| finger.core = Some(2));
    change(&mut configuration);
    findings(&configuration, root.path())
}

#[test]
fn a_good_machine_is_good() {
    let findings = found("proc/x", "", |_| {});
    assert_eq!(findings.len(), 6);
    assert!(findings.iter().all(|finding| finding.verdict == Rating::Good), "{findings:#?}");
}

#[test]
fn each_defect_is_found_alone_with_its_remedy() {
    use Rating::{Failure, Warning};
    let limits = |memory, priority| {
        format!("Max locked memory  {memory}  {memory} bytes\nMax realtime priority  {priority}  0\n")
    };
    let status = |capabilities, cores| format!("CapEff:\t{capabilities}\nCpus_allowed_list:\t{cores}\n");
    for (path, text, subject, verdict, remedy) in [
        ("proc/version", "Linux version 6.1.0 #1 SMP PREEMPT_DYNAMIC".into(), "kernel", Warning, "linux-image-rt"),
        ("proc/sys/kernel/sched_rt_runtime_us", "-1".into(), "real-time throttling", Warning, "950000"),
        ("proc/sys/kernel/sched_rt_runtime_us", "0".into(), "real-time throttling", Failure, "950000"),
        ("proc/sys/kernel/sched_rt_runtime_us", "200000".into(), "real-time throttling", Warning, "950000"),
        ("proc/sys/kernel/sched_rt_period_us", "10000000".into(), "real-time throttling", Warning, "=9500000"),
        ("proc/self/limits", limits("unlimited", "0"), "real-time priority", Warning, "rtprio 90"),
        ("proc/self/limits", limits("65536", "90"), "locked memory", Warning, "memlock unlimited"),
        ("proc/self/status", status("0", "0-1"), "cores", Warning, "finger.core"),
        ("sys/devices/system/cpu/isolated", "3".into(), "cores", Warning, "isolcpus=2"),
        (
            "sys/devices/system/cpu/cpu3/cpufreq/scaling_governor",
            "powersave".into(),
            "frequency governor",
            Warning,
            "cpupower",
        ),
        ("proc/sys/kernel/sched_rt_runtime_us", "5000".into(), "real-time throttling", Warning, "950000"),
    ] {
        let findings = found(path, &text, |_| {});
        let bad: Vec<_> = findings.iter().filter(|finding| finding.verdict != Rating::Good).collect();
        assert_eq!(bad.len(), 1, "{path} {text}: {findings:#?}");
        assert_eq!((bad[0].subject.as_str(), bad[0].verdict), (subject, verdict), "{bad:?}");
        assert!(bad[0].advice.contains(remedy), "{bad:?}");
    }
}

#[test]
fn capabilities_replace_limits_and_enforcing_makes_failures() {
    let none = "Max locked memory  0  0 bytes\nMax realtime priority  0  0\n";
    let failures = found("proc/self/limits", none, |configuration| configuration.hand.real_time = RealTime::Enforce);
    assert_eq!(failures.iter().filter(|finding| finding.verdict == Rating::Failure).count(), 2, "{failures:#?}");

    let (wanted, limits) = (Configuration::default(), Some(0));
    assert_eq!(scheduling(&wanted, limits, true).verdict, Rating::Good);
    assert_eq!(memory(&wanted, limits, true).verdict, Rating::Good);
    let status = "CapEff:\t0000000000804000\n";
    assert!(has(status, CAP_IPC_LOCK) && has(status, CAP_SYS_NICE) && !has(status, 0) && !has("", CAP_SYS_NICE));
}

/// The ring buffers of the servos are in locked memory, and their size grows with the rate. The limit that the doctor
/// requires must be higher than the locked memory that docs/real-time.md states.
#[test]
fn the_locked_memory_that_is_needed_depends_on_the_rate() {
    let limits = |mebibytes: u64| {
        let bytes = mebibytes << 20;
        format!("Max locked memory  {bytes}  {bytes} bytes\nMax realtime priority  90  90\n")
    };
    let verdict = |mebibytes, rate| {
        let findings = found("proc/self/limits", &limits(mebibytes), |configuration| configuration.hand.rate = rate);
        findings.iter().find(|finding| finding.subject == "locked memory").expect("it is checked").verdict
    };
    let page = include_str!("../../../../docs/real-time.md").split_whitespace().collect::<Vec<_>>().join(" ");
    for (locked, rate, sentence) in [
        (5, 1000.0, "They lock 5 MiB in all at 1000 Hz"),
        (12, 5000.0, "for example 12 MiB at 5000 Hz. `sun2xp doctor` requires a limit that is up to 2 MiB higher,"),
    ] {
        assert!(page.contains(sentence), "docs/real-time.md does not contain: {sentence}");
        assert_eq!(verdict(locked, rate), Rating::Warning, "{locked} MiB at {rate} Hz");
        assert_eq!(verdict(locked + 2, rate), Rating::Good, "2 MiB more than {locked} MiB at {rate} Hz");
    }

    // The message with which OpenHand reports the missing permission names an amount too. This amount must satisfy the
    // doctor even at the highest rate.
    let advice = MissingPermission::Memory(io::Error::from_raw_os_error(libc::ENOMEM)).to_string();
    let named = advice.split_once("memlock limit to ").and_then(|(_, rest)| rest.split_once(" MiB")?.0.parse().ok());
    let named = named.unwrap_or_else(|| panic!("no amount: {advice}"));
    assert_eq!(verdict(named, *RATES.end()), Rating::Good, "{advice}");
}

#[test]
fn an_unlimited_priority_is_good_and_a_missing_line_is_not() {
    let limits = "Max locked memory  unlimited  unlimited bytes\nMax realtime priority  unlimited  unlimited\n";
    let findings = found("proc/self/limits", limits, |_| {});
    assert!(findings.iter().all(|finding| finding.verdict == Rating::Good), "{findings:#?}");
    assert_eq!(limit("", "Max realtime priority"), Some(0));
}

#[test]
fn cores_are_reported_in_words() {
    let found = |wanted: Option<usize>, isolated: &[usize]| {
        let mut configuration = Configuration::default();
        configuration.fingers.iter_mut().for_each(|finger| finger.core = wanted);
        cores(&configuration, &[0, 1], isolated).found
    };
    assert!(found(None, &[]).ends_with("none, so the scheduler selects them; permitted: 0, 1; isolated: none"));
    assert_eq!(found(Some(1), &[1]), "configured: 1; permitted: 0, 1; isolated: 1");
}

#[test]
fn lists_of_cores_are_read() {
    assert_eq!(listed("0-2,5\n"), [0, 1, 2, 5]);
    assert_eq!(listed("\n"), [0; 0]);
}
