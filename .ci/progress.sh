# For other scripts, which read this file with ".": shows how far a long command is.

# progress LOG WHAT COMMAND...: runs it with its output in the file LOG, and prints WHAT with the percentage that ninja
# ("[12/345] ..."), meson test ("12/345 ...") or apt (APT::Status-Fd) tells: on a terminal in a line that is written over, else a line for each fifth; nothing
# where WHAT is empty. Returns the command's exit code.
progress() {
    log=$1
    what=$2
    shift 2
    terminal=0
    [ ! -t 2 ] || [ "${TERM-dumb}" = dumb ] || terminal=1
    {
        code=0
        "$@" 2>&1 </dev/null || code=$?
        echo "exit $code"
    } | awk -v what="$what" -v log_file="$log" -v terminal="$terminal" '
        function percent_of(line,   part) {
            if (match(line, /^\[?[ 0-9]+\/[0-9]+[] ]/)) {
                sub(/^[[ ]+/, "", line)
                split(line, part, /[] \/]+/)
                return 100 * part[1] / part[2]
            }
            # What is downloaded first is a half, what is installed then the other.
            split(line, part, ":")
            if (line ~ /^dlstatus:/) return part[3] / 2
            if (line ~ /^pmstatus:/) return 50 + part[3] / 2
            return 0
        }
        BEGIN { printf "" >log_file }
        NR > 1 { print last >log_file }
        {
            last = $0
            percent = int(percent_of($0))
            if (!terminal) percent -= percent % 20
            if (what == "" || percent <= shown) next
            shown = percent
            printf terminal ? "\r    %s: %d %%" : "    %s: %d %%\n", what, percent
            fflush()
        }
        END {
            if (terminal && shown > 0) print ""
            exit substr(last, 6)
        }' >&2
}
