#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The Debian packages: made of this build, looked at by lintian, installed in a bare Debian 12 where debootstrap can make one.

usage: debian_test.py TAKT BUILD_FOLDER SOURCE_FOLDER [--bare]

Without --bare the packages are made, read and unpacked only: contents, man pages, completions, the systemd unit, lintian.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

TAKT, BUILD, SOURCE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
SKIP = 77


def run(*command, **options):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, timeout=3000, **options)
    assert done.returncode == 0, (command, done.stdout[-3000:], done.stderr[-3000:])
    return done.stdout


def make(folder):
    """The command and the module, that is: takt-dev wants all libraries, which tools/packages builds."""
    run(SOURCE / "tools" / "manuals", TAKT, BUILD / "manuals")
    groups = ["takt"] + (["python3-takt"] if list((BUILD / "python" / "takt").glob("_takt*.so")) else [])
    components = "takt_command;takt_manuals" + (";takt_python" if len(groups) > 1 else "")
    run("cpack", "-G", "DEB", "-D", f"CPACK_COMPONENTS_ALL={components}", "-D", f"CPACK_PACKAGE_DIRECTORY={folder}", "-D", "CPACK_DEBIAN_DEBUGINFO_PACKAGE=OFF", "--config", BUILD / "CPackConfig.cmake", cwd=folder)
    packages = sorted(folder.glob("*.deb"))
    assert [package.name.split("_")[0] for package in packages] == sorted(groups), packages
    return packages


def look_inside(packages, folder):
    root = folder / "root"
    for package in packages:
        run("dpkg-deb", "-x", package, root)
    assert "takt " in run(root / "usr/bin/takt", "--version")
    # A companion is found where the package puts it, also in a root of its own.
    assert (root / "usr/libexec/takt/takt-node").exists()
    assert "takt node" in run(root / "usr/bin/takt", "node", "--help")
    for name in ("takt", "takt-run", "takt-study-merge", "takt-node"):
        page = root / f"usr/share/man/man1/{name}.1.gz"
        assert page.exists(), page
        if shutil.which("man"):
            assert "NAME" in run("man", "-l", page, env={**os.environ, "LC_ALL": "C", "MANPAGER": "cat"})
    assert (root / "usr/share/man/man5/takt-scenario.5.gz").exists()
    commands = subprocess.run(["bash", "-c", f'source "{root}/usr/share/bash-completion/completions/takt"; COMP_WORDS=(takt ru); COMP_CWORD=1; _takt; echo "${{COMPREPLY[@]}}"; '
                               'COMP_WORDS=(takt run --pc); COMP_CWORD=2; _takt; echo "${COMPREPLY[@]}"'], capture_output=True, text=True, check=True).stdout.split()
    assert commands == ["run", "--pcap"], commands
    for shell, file in (("zsh", "zsh/vendor-completions/_takt"), ("fish", "fish/vendor_completions.d/takt.fish")):
        assert (root / "usr/share" / file).stat().st_size > 0
        if shutil.which(shell):
            run(shell, "-n", root / "usr/share" / file)
    unit = (root / "usr/lib/systemd/system/takt-node@.service").read_text()
    assert "NoNewPrivileges=yes" in unit and "CapabilityBoundingSet=CAP_NET_RAW CAP_SYS_NICE\n" in unit
    sandbox(root / "usr/lib/systemd/system/takt-node@.service", root)


def sandbox(unit, root):
    """The unit is sound, and what systemd thinks of its sandbox: 0 is none of the machine, 10 all of it; without a sandbox it is 9.6."""
    if not shutil.which("systemd-analyze"):
        return print("the sandbox was not looked at: no systemd-analyze")
    with tempfile.TemporaryDirectory(prefix="takt-unit-") as folder:
        there = pathlib.Path(folder) / "takt-node@robot.service"   # an instance whose command is there
        there.write_text("".join(line for line in unit.read_text().replace("/usr/bin/takt", str(root / "usr/bin/takt")).splitlines(True) if not line.startswith("Documentation=")))
        done = subprocess.run(["systemd-analyze", "verify", "--man=no", str(there)], capture_output=True, text=True, check=False, timeout=120)
        assert done.returncode == 0 and "robot" not in done.stderr, done.stderr
        done = subprocess.run(["systemd-analyze", "security", "--offline=true", "--threshold=25", str(there)], capture_output=True, text=True, check=False, timeout=120)
        assert done.returncode == 0, done.stdout + done.stderr
    return print("the sandbox:", done.stdout.strip().splitlines()[-1])


def lint(packages):
    if not shutil.which("lintian"):
        return print("not looked at by lintian: it is not installed")
    done = subprocess.run(["lintian", "--allow-root", "--fail-on", "error,warning", "--suppress-tags", "bad-distribution-in-changes-file", *map(str, packages)], capture_output=True, text=True, check=False, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    return print("lintian:", done.stdout.strip() or "clean")


def mirror():
    """Where this machine has its Debian from."""
    for line in run("apt-get", "indextargets", "--format", "$(REPO_URI) $(RELEASE)", "Created-By: Packages").splitlines():
        if line.split()[-1] == "bookworm":
            return line.split()[0]
    return ""


def install_bare(packages, folder):
    if os.geteuid() != 0 or not shutil.which("debootstrap"):
        print("not installed in a bare Debian: that takes root and debootstrap")
        sys.exit(SKIP)
    root = folder / "bare"
    run("debootstrap", "--variant=minbase", "bookworm", root, *([mirror()] if mirror() else []))
    for name in ("etc/apt/sources.list", "etc/apt/apt.conf.d", "etc/apt/auth.conf.d", "etc/apt/trusted.gpg.d", "etc/apt/sources.list.d", "etc/ssl/certs", "usr/local/share/ca-certificates"):
        there = pathlib.Path("/") / name
        if there.is_dir():
            shutil.copytree(there, root / name, dirs_exist_ok=True)
        elif there.exists():
            shutil.copy(there, root / name)
    for package in packages:
        shutil.copy(package, root / "tmp")
    run("chroot", root, "apt-get", "update")
    run("chroot", root, "apt-get", "install", "-y", "--no-install-recommends", *(f"/tmp/{package.name}" for package in packages), env={**os.environ, "DEBIAN_FRONTEND": "noninteractive"})
    there = run("chroot", root, "takt", "run", "/usr/share/takt/scenarios/robot-arm.json", "--quiet")
    assert there == run(TAKT, "run", SOURCE / "scenarios" / "robot-arm.json", "--quiet"), there
    if len(packages) > 1:
        assert run("chroot", root, "python3", "-c", "import takt; print(takt.load('/usr/share/takt/scenarios/robot-arm.json').run().digest)").strip() in there
    assert "usage" in run("chroot", root, "takt", "node", "--help").lower()
    run("chroot", root, "apt-get", "purge", "-y", "takt")
    print("installed, run and removed in a bare Debian 12")


with tempfile.TemporaryDirectory(prefix="takt-debian-") as name:
    scratch = pathlib.Path(name)
    made = make(scratch)
    look_inside(made, scratch)
    lint(made)
    if "--bare" in sys.argv:
        install_bare(made, scratch)
