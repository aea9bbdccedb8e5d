#include "base/system/interrupt.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};

static volatile sig_atomic_t requested = false;
static int stream[2] = {-1, -1};

static void notice(int number)
{
    const int before = errno;
    (void)number;
    requested = true;
    /* The pipe stays readable after the first request, so an error because it is full can be ignored. */
    const ssize_t written = write(stream[1], "", 1);
    (void)written;
    errno = before;
}

static void keep_to_itself(int fd)
{
    fcntl(fd, F_SETFD, FD_CLOEXEC);
    fcntl(fd, F_SETFL, O_NONBLOCK);
}

void ffd_interrupt_watch(void)
{
    struct sigaction action = {.sa_handler = notice, .sa_flags = SA_RESTART}, before;
    sigemptyset(&action.sa_mask);
    if (stream[0] < 0 && pipe(stream) == 0)
        for (int i = 0; i < 2; i++)
            keep_to_itself(stream[i]);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        /* A signal that the program was started to ignore (nohup) stays ignored. */
        if (sigaction(numbers[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(numbers[i], &action, NULL);
}

bool ffd_interrupt_requested(void)
{
    return requested;
}

int ffd_interrupt_stream(void)
{
    return requested ? -1 : stream[0];
}

void ffd_interrupt_ignore(void)
{
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        signal(numbers[i], SIG_IGN);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
}
