#define _DEFAULT_SOURCE /* environ, strsignal */
#include "base/process.h"
#include "base/interrupt.h"
#include "base/memory.h"
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

extern char **environ;

struct worker_process {
    pid_t id;
    int to, from; /* -1: closed */
};

/* The streams of a worker that carry what is said: not the standard ones, where a library might print. */
enum { WORKER_INPUT = 3, WORKER_OUTPUT = 4, WORKER_STREAMS = 5 };

static ffd_status fail_start(ffd_error *error, int reason)
{
    return ffd_fail(error, reason == ENOMEM ? FFD_E_MEMORY : FFD_E_IO, "a worker cannot be started: %s",
                    strerror(reason));
}

/* A pipe whose ends no other worker gets, and whose numbers are none of a worker's streams. */
static bool make_pipe(int ends[2])
{
    int low[2];
    if (pipe(low) != 0)
        return false;
    for (int i = 0; i < 2; i++)
        ends[i] = fcntl(low[i], F_DUPFD_CLOEXEC, WORKER_STREAMS);
    const int reason = errno;
    close(low[0]);
    close(low[1]);
    if (ends[0] >= 0 && ends[1] >= 0)
        return true;
    for (int i = 0; i < 2; i++)
        if (ends[i] >= 0)
            close(ends[i]);
    errno = reason;
    return false;
}

static int spawn(const char *name, int input, int output, pid_t *id)
{
    char *arguments[] = {(char *)(uintptr_t)name, NULL};
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t none;
    sigemptyset(&none);
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed)
        return failed;
    failed = posix_spawnattr_init(&attributes);
    if (!failed) {
        failed = posix_spawn_file_actions_adddup2(&actions, input, WORKER_INPUT);
        if (!failed)
            failed = posix_spawn_file_actions_adddup2(&actions, output, WORKER_OUTPUT);
        if (!failed)
            failed = posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        if (!failed)
            failed = posix_spawnattr_setsigmask(&attributes, &none);
        if (!failed)
            failed = posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
        if (!failed)
            failed = posix_spawn(id, "/proc/self/exe", &actions, &attributes, arguments, environ);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

ffd_status ffd_process_start(const char *name, worker_process **process, ffd_error *error)
{
    int input[2], output[2];
    *process = NULL;
    worker_process *made = ffd_alloc_zero(1, sizeof *made);
    if (!made)
        return ffd_fail_memory(error);
    if (!make_pipe(input)) {
        ffd_free(made);
        return fail_start(error, errno);
    }
    int failed = make_pipe(output) ? 0 : errno;
    if (!failed) {
        failed = spawn(name, input[0], output[1], &made->id);
        close(output[1]);
        if (failed)
            close(output[0]);
    }
    close(input[0]);
    if (failed) {
        close(input[1]);
        ffd_free(made);
        return fail_start(error, failed);
    }
    made->to = input[1];
    made->from = output[0];
    *process = made;
    return FFD_OK;
}

static bool write_all(int fd, const void *bytes, size_t size)
{
    const char *at = bytes;
    while (size > 0) {
        const ssize_t written = write(fd, at, size);
        if (written < 0 && errno != EINTR)
            return false;
        at += written > 0 ? written : 0;
        size -= written > 0 ? (size_t)written : 0;
    }
    return true;
}

bool ffd_process_send(worker_process *process, const void *bytes, size_t size)
{
    return write_all(process->to, bytes, size);
}

void ffd_process_wait(worker_process *const *processes, size_t count, double seconds)
{
    struct pollfd *set = ffd_alloc(count + 1, sizeof *set);
    nfds_t used = 0;
    if (!set) {
        /* Then without knowing who has something to say. */
        poll(NULL, 0, 10);
        return;
    }
    for (size_t i = 0; i < count; i++)
        if (processes[i])
            set[used++] = (struct pollfd){.fd = processes[i]->from, .events = POLLIN};
    const int interrupts = ffd_interrupt_stream();
    if (interrupts >= 0)
        set[used++] = (struct pollfd){.fd = interrupts, .events = POLLIN};
    const double milliseconds = seconds < 1e6 ? 1e3 * seconds : 1e9;
    poll(set, used, seconds < 0 ? -1 : (int)milliseconds + 1);
    ffd_free(set);
}

bool ffd_process_receive(worker_process *process, byte_buffer *bytes)
{
    struct pollfd ready = {.fd = process->from, .events = POLLIN};
    while (poll(&ready, 1, 0) > 0) {
        char block[4096];
        const ssize_t size = read(process->from, block, sizeof block);
        if (size < 0 && errno == EINTR)
            continue;
        if (size <= 0)
            return false;
        ffd_buffer_append(bytes, block, (size_t)size);
    }
    return true;
}

void ffd_process_stop(worker_process *process)
{
    kill(process->id, SIGTERM);
}

void ffd_process_kill(worker_process *process)
{
    kill(process->id, SIGKILL);
}

static void describe_end(int status, process_end *end)
{
    *end = (process_end){.code = WIFEXITED(status) ? WEXITSTATUS(status) : 0,
                         .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0};
    end->killed = end->signal == SIGKILL;
    if (end->signal)
        snprintf(end->text, sizeof end->text, "%s", strsignal(end->signal));
    else
        snprintf(end->text, sizeof end->text, "exit code %d", end->code);
}

void ffd_process_finish(worker_process **process, process_end *end)
{
    int status = 0;
    if (end)
        *end = (process_end){0};
    if (!process || !*process)
        return;
    close((*process)->to);
    close((*process)->from);
    while (waitpid((*process)->id, &status, 0) < 0 && errno == EINTR)
        ;
    if (end)
        describe_end(status, end);
    ffd_free(*process);
    *process = NULL;
}

void ffd_process_follow_parent(void)
{
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    /* Where that came too late, nobody has the other end of the pipe any more. */
    struct pollfd parent = {.fd = WORKER_INPUT, .events = POLLIN};
    if (poll(&parent, 1, 0) > 0 && (parent.revents & POLLHUP) && !(parent.revents & POLLIN))
        _exit(0);
#endif
    fcntl(WORKER_INPUT, F_SETFD, FD_CLOEXEC);
    fcntl(WORKER_OUTPUT, F_SETFD, FD_CLOEXEC);
}

bool ffd_process_take(void *bytes, size_t size)
{
    char *at = bytes;
    while (size > 0) {
        const ssize_t got = read(WORKER_INPUT, at, size);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        at += got;
        size -= (size_t)got;
    }
    return true;
}

bool ffd_process_give(const void *bytes, size_t size)
{
    return write_all(WORKER_OUTPUT, bytes, size);
}
