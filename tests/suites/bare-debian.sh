# Sourced by suites that need a bare Debian. They run as root.

# make_debian SUITE ROOT: makes a Debian of that release in the folder ROOT, unless it is there, and shows it the
# machine's processes, devices and way to Debian's packages.
make_debian() {
  root=$2
  local mirror
  mirror=$(awk '$1 == "deb" { for (i = 2; i <= NF; i++) if ($i ~ /^https?:/) { print $i; exit } }
    $1 == "URIs:" { print $2; exit }' /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null || true)
  if [[ ! -e $root/etc/debian_version ]]; then
    mkdir -p "$root"
    debootstrap --variant=minbase "$1" "$root" "${mirror:-http://deb.debian.org/debian}" >"$root.log"
    rm -f "$root.log"
  fi
  cp /etc/apt/apt.conf.d/*proxy* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  mount -t proc proc "$root/proc"
  mount --bind /dev "$root/dev"
  mount --bind /dev/pts "$root/dev/pts"
}

leave_debian() {
  [[ -n ${root-} ]] || return 0  # none was made, and the paths would be the machine's own
  umount "$root/dev/pts" "$root/dev" "$root/proc" 2>/dev/null || true
}

# inside COMMANDS: runs commands of bash in the Debian.
inside() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    ${http_proxy:+http_proxy=$http_proxy} bash -euo pipefail -c "$1"
}
