//! Whether this machine is virtual. The host of a virtual machine may pause it at any time.

use std::fs::read_to_string;
use std::path::Path;

/// Returns whether the kernel below `root` (`/`, except in tests) runs in a virtual machine.
pub fn is_virtual(root: &Path) -> bool {
    let has_flag = |text: String| {
        let mut flags = text.lines().filter(|line| line.starts_with("flags"));
        flags.any(|line| line.split_whitespace().any(|flag| flag == "hypervisor"))
    };
    // On Intel and AMD processors, a guest has this flag. On other processors, some guests have one of the two paths. A
    // guest without them is not detected.
    read_to_string(root.join("proc/cpuinfo")).is_ok_and(has_flag)
        || ["sys/hypervisor/type", "proc/device-tree/hypervisor"].iter().any(|path| root.join(path).exists())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_virtual_machine_is_found_by_its_flag_or_its_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path();
        assert!(!is_virtual(root));
        fs::create_dir_all(root.join("proc")).expect("made");
        fs::write(root.join("proc/cpuinfo"), "model name\t: hypervisor\nflags\t\t: fpu vme\n").expect("written");
        assert!(!is_virtual(root));
        fs::write(root.join("proc/cpuinfo"), "processor: 0\nflags\t\t: fpu hypervisor vme\n").expect("written");
        assert!(is_virtual(root));
        fs::remove_dir_all(root.join("proc")).expect("removed");
        fs::create_dir_all(root.join("sys/hypervisor")).expect("made");
        fs::write(root.join("sys/hypervisor/type"), "xen\n").expect("written");
        assert!(is_virtual(root));
    }
}
