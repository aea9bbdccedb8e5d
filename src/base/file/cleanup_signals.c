/* cleanup_signals.c - the lock of cleanup.h, and its handlers of signals. */
#define _DEFAULT_SOURCE /* SA_RESETHAND */
#include "base/file/cleanup.h"
#include "base/file/cleanup_list.h"
#include <ffd/program.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>

/* Signals from outside, and SIGPIPE, whose default action ends the program. */
static const int signals[] = {SIGHUP, SIGINT, SIGPIPE, SIGQUIT, SIGTERM};
enum { SIGNALS = sizeof signals / sizeof *signals };

static atomic_flag held = ATOMIC_FLAG_INIT;
static atomic_bool is_over;     /* a signal handler holds or awaits the lock: nobody else may take it */
static sigset_t mask_of_holder; /* signal mask of the lock's holder before it took the lock; protected by the
                                   lock */

static bool try_lock(void)
{
    return !atomic_flag_test_and_set_explicit(&held, memory_order_acquire);
}

/* Sleeps for a millisecond, with a function that is async-signal-safe. */
static void wait_a_little(void)
{
    poll(NULL, 0, 1);
}

void ffd_cleanup_hold(void)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    while (atomic_load(&is_over) || !try_lock())
        wait_a_little();
    mask_of_holder = before;
}

void ffd_cleanup_release(void)
{
    const sigset_t before = mask_of_holder;
    atomic_flag_clear_explicit(&held, memory_order_release);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

/* Keeps the lock, so that nothing is created or renamed any more. The signal has its default action again
   (SA_RESETHAND) and is raised again: it is delivered when the handler returns, and ends the program as if
   there were no handler. */
static void clean_up(int signal)
{
    atomic_store(&is_over, true);
    while (!try_lock())
        wait_a_little();
    ffd_cleanup_remove_all();
    raise(signal);
}

/* If the thread that crashed holds the lock, the list may be inconsistent, and is not used. */
static void clean_up_crash(int signal)
{
    int tries = 1000;
    atomic_store(&is_over, true);
    for (; tries > 0 && !try_lock(); tries--)
        wait_a_little();
    if (tries > 0)
        ffd_cleanup_remove_all();
    raise(signal);
}

/* Installs the handler for those of the signals that have the default action. */
static void install(void (*handler)(int signal), const int *numbers, int count)
{
    struct sigaction action = {.sa_handler = handler, .sa_flags = (int)SA_RESETHAND}, old;
    sigfillset(&action.sa_mask);
    for (int i = 0; i < count; i++)
        if (sigaction(numbers[i], NULL, &old) == 0 && old.sa_handler == SIG_DFL)
            sigaction(numbers[i], &action, NULL);
}

void ffd_cleanup_on_signals(void)
{
    install(clean_up, signals, SIGNALS);
#ifdef SIGXFSZ
    signal(SIGXFSZ, SIG_IGN);
#endif
}

void ffd_cleanup_on_crashes(void)
{
    static const int stop = SIGALRM, crashes[] = {SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV};
    install(clean_up, &stop, 1);
    install(clean_up_crash, crashes, sizeof crashes / sizeof *crashes);
}
