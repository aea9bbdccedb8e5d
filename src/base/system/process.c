#define _DEFAULT_SOURCE /* environ, strsignal */
#include "base/system/process.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include "base/system/interrupt.h"
#include "base/system/null_device.h"
#include "base/system/own_file.h"
#include <errno.h>
#include <signal.h>
#include <spawn.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#ifdef __linux__
#include <sys/auxv.h>
#include <sys/prctl.h>
#endif

/* macOS, where older systems do not know the flag of send: there the option of a socket says it. */
#ifndef MSG_NOSIGNAL
#define MSG_NOSIGNAL 0
#endif

extern char **environ;

struct worker_process {
    pid_t id;
    int channel;
};

/* The file descriptor of the channel in a worker: not a standard stream, because a library might print to
   these. */
enum { CHANNEL = 3 };

static ffd_status fail_start(ffd_error *error, int reason)
{
    return ffd_fail(error, reason == ENOMEM ? FFD_E_MEMORY : FFD_E_IO, "a worker cannot be started: %s",
                    strerror(reason));
}

/* Of a socket, for both processes: sending to a worker or a parent that has ended raises no SIGPIPE. */
static bool keep_quiet(int socket)
{
#ifdef SO_NOSIGPIPE
    const int on = 1;
    return setsockopt(socket, SOL_SOCKET, SO_NOSIGPIPE, &on, sizeof on) == 0;
#else
    (void)socket;
    return true; /* by MSG_NOSIGNAL */
#endif
}

/* Makes a pair of sockets that other workers do not inherit, with descriptors other than CHANNEL. A pipe
   would raise SIGPIPE if its worker has ended. */
static bool make_channel(int ends[2])
{
    int low[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, low) != 0)
        return false;
    for (int i = 0; i < 2; i++)
        ends[i] = keep_quiet(low[i]) ? fcntl(low[i], F_DUPFD_CLOEXEC, CHANNEL + 1) : -1;
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

/* Finds the file of this program by its name, where there is no /proc. Returns NULL if it is unknown. */
static const char *find_self(char path[LONGEST_PATH])
{
#ifdef __linux__
    (void)path;
    return (const char *)getauxval(AT_EXECFN); /* also in a static program, and of any length */
#else
    static const char here;
    return ffd_find_own_file(&here, path) ? path : NULL;
#endif
}

/* program: NULL for this one. */
static int spawn_program(const char *program, const posix_spawn_file_actions_t *actions,
                         const posix_spawnattr_t *attributes, char *const arguments[], pid_t *id)
{
    char path[LONGEST_PATH];
    const int failed =
        posix_spawn(id, program ? program : "/proc/self/exe", actions, attributes, arguments, environ);
    const char *const self = failed == ENOENT && !program ? find_self(path) : NULL;
    return self ? posix_spawn(id, self, actions, attributes, arguments, environ) : failed;
}

/* null: what the worker has in place of standard input and output. */
static int spawn(const char *program, const char *name, const char *build, int channel, int null, pid_t *id)
{
    char *arguments[] = {(char *)(uintptr_t)name, (char *)(uintptr_t)build, NULL};
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    /* Signals that end programs are blocked until the worker ignores them (ffd_interrupt_ignore). */
    sigset_t wishes;
    sigemptyset(&wishes);
    sigaddset(&wishes, SIGHUP);
    sigaddset(&wishes, SIGINT);
    sigaddset(&wishes, SIGTERM);
    sigaddset(&wishes, SIGALRM);
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed)
        return failed;
    failed = posix_spawnattr_init(&attributes);
    if (!failed) {
        failed = posix_spawn_file_actions_adddup2(&actions, null, STDIN_FILENO);
        if (!failed)
            failed = posix_spawn_file_actions_adddup2(&actions, null, STDOUT_FILENO);
        /* The last one: null may have the number CHANNEL. */
        if (!failed)
            failed = posix_spawn_file_actions_adddup2(&actions, channel, CHANNEL);
        if (!failed)
            failed = posix_spawnattr_setsigmask(&attributes, &wishes);
        if (!failed)
            failed = posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
        if (!failed)
            failed = spawn_program(program, &actions, &attributes, arguments, id);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

ffd_status ffd_process_start(const char *program, const char *name, const char *build,
                             worker_process **process, ffd_error *error)
{
    int ends[2] = {-1, -1};
    *process = NULL;
    worker_process *made = ffd_alloc_zero(1, sizeof *made);
    if (!made)
        return ffd_fail_memory(error);
    int failed = make_channel(ends) ? 0 : errno;
    if (!failed) {
        const int null = ffd_null_open(true);
        failed = null < 0 ? errno : spawn(program, name, build, ends[1], null, &made->id);
        if (null >= 0)
            close(null);
        close(ends[1]);
        if (failed)
            close(ends[0]);
    }
    if (failed) {
        ffd_free(made);
        return fail_start(error, failed);
    }
    made->channel = ends[0];
    *process = made;
    return FFD_OK;
}

static bool send_all(int fd, const void *bytes, size_t size)
{
    const char *at = bytes;
    while (size > 0) {
        const ssize_t sent = send(fd, at, size, MSG_NOSIGNAL);
        if (sent < 0 && errno != EINTR)
            return false;
        at += sent > 0 ? sent : 0;
        size -= sent > 0 ? (size_t)sent : 0;
    }
    return true;
}

bool ffd_process_send(worker_process *process, const void *bytes, size_t size)
{
    return send_all(process->channel, bytes, size);
}

void ffd_process_wait(worker_process *const *processes, size_t count, int input, double seconds)
{
    struct pollfd *set = ffd_alloc(count + 2, sizeof *set);
    nfds_t used = 0;
    if (!set) {
        /* A short pause, because it is unknown which process will send something. */
        poll(NULL, 0, 10);
        return;
    }
    for (size_t i = 0; i < count; i++)
        if (processes[i])
            set[used++] = (struct pollfd){.fd = processes[i]->channel, .events = POLLIN};
    if (input >= 0)
        set[used++] = (struct pollfd){.fd = input, .events = POLLIN};
    const int interrupts = ffd_interrupt_stream();
    if (interrupts >= 0)
        set[used++] = (struct pollfd){.fd = interrupts, .events = POLLIN};
    const double milliseconds = seconds < 1e6 ? 1e3 * seconds : 1e9;
    poll(set, used, seconds < 0 ? -1 : (int)milliseconds + 1);
    ffd_free(set);
}

bool ffd_process_receive(worker_process *process, byte_buffer *bytes)
{
    char block[4096];
    ssize_t size;
    do {
        size = recv(process->channel, block, sizeof block, MSG_DONTWAIT);
        if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK))
            return true;
        if (size == 0 || (size < 0 && errno != EINTR))
            return false;
        ffd_buffer_append(bytes, block, size < 0 ? 0 : (size_t)size);
    } while (size < 0 || (size_t)size == sizeof block); /* a short read: nothing else is there yet */
    return true;
}

void ffd_process_stop(worker_process *process)
{
    kill(process->id, SIGALRM);
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
    close((*process)->channel);
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
    char byte;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    /* If the parent ended before that call, it has closed the other end. */
    if (recv(CHANNEL, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0)
        _exit(0);
#endif
    fcntl(CHANNEL, F_SETFD, FD_CLOEXEC);
}

void ffd_process_defer_stop(bool wait)
{
    sigset_t stop;
    sigemptyset(&stop);
    sigaddset(&stop, SIGALRM);
    sigprocmask(wait ? SIG_BLOCK : SIG_UNBLOCK, &stop, NULL);
}

bool ffd_process_take(void *bytes, size_t size)
{
    char *at = bytes;
    while (size > 0) {
        const ssize_t got = read(CHANNEL, at, size);
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
    return send_all(CHANNEL, bytes, size);
}
