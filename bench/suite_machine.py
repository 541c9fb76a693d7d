# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What a figure of the suite depends on beside the program: the machine, the commit, the compiler."""
import datetime
import os
import pathlib
import platform
import re
import subprocess


def said(command, seconds=60, **more):
    """What a program prints, stripped; "" where there is no such program, it fails or takes longer."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=seconds, **more)
        return (done.stdout + done.stderr).strip() if done.returncode == 0 else ""
    except (OSError, subprocess.TimeoutExpired):
        return ""


def text(path):
    try:
        return pathlib.Path(path).read_text(errors="replace").strip()
    except OSError:
        return ""


def usable_cores():
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def machine():
    info = text("/proc/cpuinfo")
    model = re.search(r"^model name\s*:\s*(.+)$", info, re.M)
    memory = re.search(r"^MemTotal:\s*(\d+) kB", text("/proc/meminfo"), re.M)
    siblings = text("/sys/devices/system/cpu/cpu0/topology/thread_siblings_list")
    release = re.search(r'^PRETTY_NAME="?([^"\n]*)', text("/etc/os-release"), re.M)
    return {
        "processor": model.group(1) if model else platform.processor(),
        "usable_cores": usable_cores(),
        "hardware_threads_a_core": len(siblings.replace("-", ",").split(",")) if siblings else None,
        "governor": text("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor") or "unknown",
        "memory_bytes": 1024 * int(memory.group(1)) if memory else None,
        "huge_pages": text("/sys/kernel/mm/transparent_hugepage/enabled") or "unknown",
        "system": release.group(1) if release else platform.system(),
        "kernel": platform.release(),
        "virtual": " hypervisor" in info,
        "load_before": os.getloadavg()[0],
    }


def commit(root):
    """The commit of the tree, and whether its files are that commit's. Not necessarily what the command was built from."""
    found = said(["git", "-C", str(root), "rev-parse", "HEAD"])
    return {"commit": found or "unknown",
            "changed_files": len(said(["git", "-C", str(root), "status", "--porcelain"]).splitlines()) if found else None}


def compiler(command):
    """Of the build folder that the command lies in."""
    for folder in pathlib.Path(command).resolve().parents:
        cache = text(folder / "CMakeCache.txt")
        if not cache:
            continue
        get = lambda key: (re.search(rf"^{key}:\w+=(.*)$", cache, re.M) or [None, ""])[1]
        kind = get("CMAKE_BUILD_TYPE")
        version = said([get("CMAKE_CXX_COMPILER"), "--version"]).splitlines()
        flags = " ".join(filter(None, [get("CMAKE_CXX_FLAGS"), get("CMAKE_CXX_FLAGS_" + kind.upper())]))
        return {"compiler": version[0] if version else "unknown", "build_type": kind, "flags": flags}
    return {"compiler": "unknown", "build_type": "unknown", "flags": "unknown"}


def words(found):
    """A record in few words, for the foot of a table."""
    m = found["machine"]
    return (f"{m['processor']}, {m['usable_cores']} usable cores, {found['date'][:10]}, commit {found['commit'][:12]}, load before "
            f"{m['load_before']:.1f}")


def record(root, command):
    return {"date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"), "machine": machine(),
            **commit(root), **compiler(command)}
