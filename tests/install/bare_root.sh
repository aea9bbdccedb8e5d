#!/bin/sh
# A root folder of Debian that holds nothing but its essential packages and apt (mmdebstrap --variant=minbase), and in it a clone
# of the last commit: what a developer's machine has by chance is not there. Needs root, mmdebstrap, git and unshare.
#     sh tests/install/bare_root.sh make FOLDER [--release NAME] [--models FOLDER] [--user] [-- PACKAGE...]
#                                 --release  the code name of a Debian (default: bookworm)
#                                 --models   sample models, which come to lie beside the clone as shared/models
#                                 --user     a user "somebody" owns the clone, who may use sudo
#                                 PACKAGE    what else is in it
#     sh tests/install/bare_root.sh run FOLDER [--user] [--closed] COMMAND
#                                 runs a line of sh in the clone, as root or as that user
#                                 --closed   as in a container: no mounts, no namespaces
# From the machine come the sources of apt, certificates, and the settings of proxies and of package clients.
set -eu

here=$(cd "$(dirname "$0")" && pwd)
clone=/src/ffd
bundle=/etc/ssl/certs/ca-certificates.crt

fail() {
    echo "bare root: $1" >&2
    exit 1
}

# The machine's sources of Debian packages, for another release, as lines of a sources.list; nothing where it has none.
sources() {
    codename=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
    apt-get indextargets --format '$(LABEL)|deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 2>/dev/null |
        sed -n 's/^Debian[^|]*|//p' | grep -E " $codename(-updates|-security)? " | sed "s/ $codename\([ -]\)/ $1\1/" | sort -u
}

# What apt's settings say of how to reach a source: proxies, certificates, dates. One setting a line.
access() {
    apt-config dump Acquire 2>/dev/null | grep -E '^Acquire::(https?|Check-|Retries|ForceIPv)' | grep -v ' "";$' || :
}

# Settings of the environment: where certificates are, proxies, and what package clients are told. NAME='VALUE' for sh.
environment() {
    env | grep -E '^(([a-z]+_proxy|[A-Z]+_PROXY)|SSL_CERT_(FILE|DIR)|CURL_CA_BUNDLE|REQUESTS_CA_BUNDLE|NODE_EXTRA_CA_CERTS|PIP_[A-Z_]+|npm_config_[a-z_]+|NPM_CONFIG_[A-Z_]+)=' |
        sed "s/'/'\\\\''/g; s/=\(.*\)/='\1'/"
}

# home_of USER: in the root
home_of() {
    sed -n "s/^$1:.*:\([^:]*\):[^:]*$/\1/p" "$folder/etc/passwd"
}

# copy FILE...: to the same place in the root, where there are such
copy() {
    for file; do
        [ -e "$file" ] || continue
        mkdir -p "$folder$(dirname "$file")"
        cp -RL "$file" "$folder$(dirname "$file")/"
    done
}

make_root() {
    release=bookworm
    models=
    user=
    while [ $# -gt 0 ]; do
        case "$1" in
        --release | --models)
            [ $# -ge 2 ] || fail "$1 needs a value"
            [ "$1" = --release ] && release=$2 || models=$2
            shift
            ;;
        --user) user=1 ;;
        --) shift && break ;;
        *) fail "unknown argument '$1'" ;;
        esac
        shift
    done
    packages=$(echo "$*" | tr ' ' ,)
    [ -z "$user" ] || packages="$packages${packages:+,}sudo"

    settings=$(mktemp)
    access >"$settings"
    set -- "$release" "$folder"
    [ -z "$(sources "$release")" ] || { sources "$release" >"$settings.list" && set -- "$@" "$settings.list"; }
    mmdebstrap --quiet --variant=minbase --dpkgopt=force-unsafe-io --aptopt="$settings" ${packages:+--include="$packages"} "$@" ||
        fail "mmdebstrap failed"
    rm -f "$settings" "$settings.list"
    copy /etc/resolv.conf /etc/hosts /usr/local/share/ca-certificates "$bundle" /etc/pip.conf /etc/npmrc /etc/apt/auth.conf.d
    environment >"$folder/etc/machine.env"
    [ -z "$user" ] || chroot "$folder" useradd --create-home --shell /bin/sh somebody
    for name in root ${user:+somebody}; do
        [ ! -f "$HOME/.npmrc" ] || cp "$HOME/.npmrc" "$folder$(home_of "$name")/"
    done

    mkdir -p "$folder${clone%/*}"
    git clone --quiet --no-hardlinks "$here/../.." "$folder$clone"
    if [ -n "$models" ]; then
        mkdir -p "$folder${clone%/*}/shared"
        cp -R "$models" "$folder${clone%/*}/shared/models"
    fi
    if [ -n "$user" ]; then
        echo 'somebody ALL=(ALL) NOPASSWD: ALL' >"$folder/etc/sudoers.d/somebody"
        chroot "$folder" chown -R somebody: "${clone%/*}"
    fi
}

run() {
    user=
    closed=
    while [ $# -gt 1 ]; do
        case "$1" in
        --user) user=1 ;;
        --closed) closed=1 ;;
        *) fail "unknown argument '$1'" ;;
        esac
        shift
    done
    name=root
    folders=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin
    enter="sh -c"
    if [ -n "$user" ]; then
        name=somebody
        folders=/usr/local/bin:/usr/bin:/bin
        enter="setpriv --reuid=somebody --regid=somebody --init-groups sh -c"
    fi
    outside=
    [ -z "$closed" ] || outside="python3 $here/closed.py"
    command="set -a; . /etc/machine.env; set +a; cd $clone; $1"
    # A namespace of its own for mounts and processes: with the command ends what it has started, and nothing stays mounted.
    # shellcheck disable=SC2016,SC2086 # it is expanded there; words
    export outside
    exec unshare --mount --pid --fork --kill-child sh -c '
        mount --bind "$1" "$1" && mount --bind /dev "$1/dev" && mount -t proc proc "$1/proc" && mount --rbind /sys "$1/sys" && mount -t tmpfs -o mode=1777 shm "$1/dev/shm" &&
            mount -t devpts -o newinstance,ptmxmode=666,mode=620 pts "$1/dev/pts" || exit 1
        root=$1
        shift
        exec $outside chroot "$root" "$@"' sh "$folder" env -i HOME="$(home_of $name)" USER=$name PATH=$folders TERM=dumb $enter "$command"
}

[ $# -ge 2 ] || fail "make FOLDER, or run FOLDER COMMAND, is needed"
[ "$(id -u)" -eq 0 ] || fail "root is needed to make and enter it"
action=$1
folder=$2
shift 2
case "$action" in
make) make_root "$@" ;;
run) run "$@" ;;
*) fail "unknown action '$action'" ;;
esac
