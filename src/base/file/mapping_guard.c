/* mapping_guard.c - the handler of SIGBUS for mapped inputs (mapping.h). */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "base/file/mapping.h"
#include "base/posix.h"
#include <errno.h>
#include <ffd/program.h>
#include <signal.h>
#include <stdbool.h>

static size_t page_size;
static struct sigaction other_handler;

/* Maps pages of zeros over a truncated mapping, from the page of an address on. Returns false if the address
   is not in a mapped input. */
static bool patch(uintptr_t address)
{
    const uintptr_t page = address / page_size * page_size;
    const size_t rest = ffd_mapping_cut(address);
    return rest > 0 && mmap((void *)page, address - page + rest, PROT_READ,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) != MAP_FAILED;
}

/* Whether a process has sent the signal: it does not recur when the handler returns. The codes are not
   positive, but on macOS they are these two. */
static bool is_sent(const siginfo_t *info)
{
    return info->si_code <= 0 || info->si_code == SI_USER || info->si_code == SI_QUEUE;
}

/* Passes a signal that does not concern an input to the previous handler. */
static void pass_on(int number, siginfo_t *info, void *context)
{
    const bool is_default = other_handler.sa_handler == SIG_DFL || other_handler.sa_handler == SIG_IGN;
    if (is_default || other_handler.sa_flags & (int)SA_RESETHAND) {
        sigaction(number, &other_handler, NULL);
        if (is_sent(info))
            raise(number);
    } else if (other_handler.sa_flags & SA_SIGINFO) {
        other_handler.sa_sigaction(number, info, context);
    } else {
        other_handler.sa_handler(number);
    }
}

static void on_bus_error(int number, siginfo_t *info, void *context)
{
    const int before = errno;
    if (is_sent(info) || !patch((uintptr_t)info->si_addr))
        pass_on(number, info, context);
    errno = before;
}

void ffd_guard_inputs(void)
{
    struct sigaction action = {.sa_sigaction = on_bus_error, .sa_flags = SA_SIGINFO | SA_ONSTACK}, old;
    sigemptyset(&action.sa_mask);
    page_size = (size_t)sysconf(_SC_PAGESIZE);
    if (sigaction(SIGBUS, NULL, &old) != 0 || (old.sa_flags & SA_SIGINFO && old.sa_sigaction == on_bus_error))
        return;
    other_handler = old;
    sigaction(SIGBUS, &action, NULL);
}
