#!/usr/bin/env bash
# Builds and tests glint in a fresh Debian 13 (Embree 4), on whatever Debian this is:
#
#     tests/debian13.sh [FOLDER [COMMAND...]]
#
# FOLDER holds the system and the build, and is kept for the next run (default: glint-trixie in the
# temporary folder). COMMAND runs in the sources and is `cargo test` when not given. Needs root and
# debootstrap. The Rust toolchain, the crates and the sources are this machine's, the sources read-only;
# everything else is what `./x setup` installs, so this is also the test of the set-up.
# SUITE=bookworm does the same with a fresh Debian 12 (Embree 3).
set -euo pipefail

suite=${SUITE:-trixie}
[ "$(id -u)" = 0 ] || { echo "debian13: needs root" >&2 && exit 1; }
command -v debootstrap >/dev/null || apt-get -qq install --no-install-recommends debootstrap

# In a mount namespace of our own, so that no mount outlives this script, however it ends.
if [ -z "${GLINT_PRIVATE_MOUNTS:-}" ]; then
    GLINT_PRIVATE_MOUNTS=1 exec unshare --mount "$0" "$@"
fi

sources=$(realpath "$(dirname "$0")/..")
folder=$(realpath -m "${1:-${TMPDIR:-/tmp}/glint-$suite}")
[ $# = 0 ] || shift
[ $# != 0 ] || set -- cargo test --locked --offline

# The system, once.
if [ ! -e "$folder/debootstrap-is-done" ]; then
    rm -rf --one-file-system "$folder"
    debootstrap --variant=minbase --include=ca-certificates "$suite" "$folder" \
        "${DEBIAN_MIRROR:-http://deb.debian.org/debian}" >"$folder.log" || { cat "$folder.log" && exit 1; }
    touch "$folder/debootstrap-is-done"
fi
cp -L /etc/resolv.conf "$folder/etc/resolv.conf"

# What it shares with this machine.
cargo fetch --locked --manifest-path "$sources/Cargo.toml"
mkdir -p "$folder"/{glint,target,rust,cargo/registry}
mount --bind -o ro "$sources" "$folder/glint"
mount --bind -o ro "$(rustc --print sysroot)" "$folder/rust"
mount --bind "${CARGO_HOME:-$HOME/.cargo}/registry" "$folder/cargo/registry"
mount -t proc proc "$folder/proc"

inside() {
    chroot "$folder" env -i PATH=/rust/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
        CARGO_HOME=/cargo CARGO_TARGET_DIR=/target ${GLINT_FULL:+GLINT_FULL="$GLINT_FULL"} \
        sh -c 'cd /glint && exec "$@"' sh "$@"
}

inside ./x setup
echo "debian13: $(inside sh -c '. /etc/os-release && echo "$PRETTY_NAME"'), Embree" \
    "$(inside dpkg-query -W -f '${Version}' libembree-dev), $(inside rustc --version)"
if inside "$@"; then
    echo "debian13: passed: $*"
else
    echo "debian13: FAILED: $*" >&2 && exit 1
fi
