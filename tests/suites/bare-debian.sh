# Sourced by suites that need a bare Debian. They run as root.

# make_debian SUITE ROOT: makes a Debian of that release in the folder ROOT, unless it is there.
make_debian() {
  root=$2
  local mirror
  mirror=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/debian.sources 2>/dev/null |
    awk '$1 == "deb" { for (i = 2; i <= NF; i++) if ($i ~ /^https?:/) { print $i; exit } } $1 == "URIs:" { print $2; exit }' || true)
  if [[ ! -e $root ]]; then
    rm -rf --one-file-system "$root.new"
    mkdir -p "$root.new"
    debootstrap --variant=minbase "$1" "$root.new" "${mirror:-http://deb.debian.org/debian}" >"$root.log" || return
    rm -f "$root.log"
    mv "$root.new" "$root"
  fi
  cp /etc/apt/apt.conf.d/*proxy* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
  cp /etc/resolv.conf "$root/etc/resolv.conf"
}

# inside COMMANDS: runs commands of bash in the Debian, which sees the machine's processes, devices and way to Debian's
# packages. They are mounted for the commands only.
inside() {
  unshare --mount bash -euc 'mount -t proc proc "$0/proc"; mount --rbind /dev "$0/dev"
    exec chroot "$0" "$@"' "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive ${http_proxy:+http_proxy=$http_proxy} ${https_proxy:+https_proxy=$https_proxy} \
    ${no_proxy:+no_proxy=$no_proxy} bash -euo pipefail -c "$1"
}
