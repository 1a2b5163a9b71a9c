#!/usr/bin/env bash
# Runs the tests of the AVX-512 kernels on an emulated processor, for machines that have none. Takes some ten minutes.
#
# A static test binary is the init of a Linux kernel that Bochs boots as a Skylake-X. Needs Debian's packages bochs,
# bochs-term, isolinux, syslinux-common, xorriso, cpio, util-linux and (downloaded here) a cloud kernel.
# ANTUMBRA_ITF1788 names the folder of the ITF1788 vectors. Usage: avx512-emulated.sh [FOLDER FOR ITS FILES]
set -euo pipefail
: "${ANTUMBRA_ITF1788:?names the folder of the ITF1788 vectors}"
root="$(cd "$(dirname "$0")/.." && pwd)"
work="${1:-$(mktemp -d)}"
mkdir -p "$work"
cd "$work"
echo "files in $work"

if ! compgen -G 'kernel/boot/vmlinuz-*' >/dev/null; then
    package="$(apt-cache depends linux-image-cloud-amd64 | awk '/Depends: linux-image/ { print $2; exit }')"
    apt-get download -q "$package"
    dpkg-deb -x "$package"_*.deb kernel
fi

export RUSTFLAGS="-Ctarget-feature=+crt-static" CARGO_TARGET_DIR="$work/target"
(cd "$root" && cargo test -p antumbra-interval --target x86_64-unknown-linux-gnu --no-run --locked \
    --test lanes --test ieee1788 2>&1 | tee "$work/build.log")

# boot NAME FILTER...: runs a test binary; the kernel panics when its init ends, which is meant.
boot() {
    local name="$1" binary
    shift
    rm -rf "$name"
    mkdir -p "$name/root/dev" "$name/root/vectors" "$name/iso/isolinux"
    binary="$(sed -n "s#.*(\(.*/deps/$name-[0-9a-f]*\)).*#\1#p" build.log)"
    cp "$binary" "$name/root/init"
    strip "$name/root/init"
    cp "$ANTUMBRA_ITF1788"/*.itl "$name/root/vectors/"
    (cd "$name/root" && find . | cpio -o -H newc 2>/dev/null) >"$name/iso/initrd.img"
    cp kernel/boot/vmlinuz-* "$name/iso/vmlinuz"
    cp /usr/lib/ISOLINUX/isolinux.bin /usr/lib/syslinux/modules/bios/ldlinux.c32 "$name/iso/isolinux/"
    # The saved state of Bochs is not what the kernel expects: without these two words it switches AVX-512 off. Words that
    # the kernel does not know become arguments of init and filter its tests: so the filters name all that are wanted.
    cat >"$name/iso/isolinux/isolinux.cfg" <<EOF
DEFAULT t
PROMPT 0
TIMEOUT 1
LABEL t
 KERNEL /vmlinuz
 APPEND initrd=/initrd.img console=ttyS0 ANTUMBRA_ITF1788=/vectors clearcpuid=xsavec noxsaves mitigations=off acpi=off pci=off trace_clock=local lpj=1000000 panic=0 -- --test-threads=1 --nocapture $*
EOF
    xorriso -as mkisofs -quiet -o "$name/boot.iso" -b isolinux/isolinux.bin -c isolinux/boot.cat -no-emul-boot \
        -boot-load-size 4 -boot-info-table "$name/iso" 2>/dev/null
    cat >"$name/bochsrc" <<EOF
display_library: term
cpu: model=corei7_skylake_x, ips=50000000, reset_on_triple_fault=0
memory: guest=512, host=512
romimage: file=/usr/share/bochs/BIOS-bochs-latest
vgaromimage: file=/usr/share/bochs/VGABIOS-lgpl-latest
ata0-master: type=cdrom, path=$work/$name/boot.iso, status=inserted
boot: cdrom
com1: enabled=1, mode=file, dev=$work/$name/serial.txt
log: $work/$name/bochs.log
panic: action=report
error: action=report
info: action=ignore
debug: action=ignore
clock: sync=none
EOF
    # Debian's Bochs starts in its debugger: continue. It wants a terminal, and stays when the machine has stopped.
    echo c >"$name/debugger"
    timeout -s KILL 3000 script -qfc "bochs -q -f $work/$name/bochsrc -rc $name/debugger" "$name/terminal.txt" >/dev/null </dev/null &
    local emulator=$!
    while kill -0 "$emulator" 2>/dev/null && ! grep -qs "^test result" "$name/serial.txt"; do
        sleep 2
    done
    sleep 2
    pgrep -f "bochs-bin.* -f $work/$name/bochsrc" | xargs -r kill -KILL
    wait "$emulator" || true
    tr -d '\r' <"$name/serial.txt" | grep -v '^\[ '
    grep -q "^test result: ok" "$name/serial.txt"
}

boot ieee1788 vectors_results wrong_results
grep -q "ITF1788 on lanes, Avx512" ieee1788/serial.txt
boot lanes directed any_length nan portable functions
