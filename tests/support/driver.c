/* driver.c - a fork server for the program's command lines.

   Starting the program takes longer than most of its work in tests: the dynamic linker, the C++ library and,
   above all, a sanitizer. This process has started already. It takes command lines from a socket and runs
   each in a forked child with the program's own main, so that exit(), signals, globals and memory stay
   separate.

   A packet holds three numbers (of words, of variables, umask) and then texts, each terminated by 0: the
   working folder, the words with the program's name first, and the environment. Standard input, output and
   error are passed as descriptors. The answer is the child's status from waitpid. */
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <errno.h>
#include <malloc.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

int ffd_main(int argc, char **argv);
#define main ffd_main
#include "cli/main.c"
#undef main

#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
#define IS_SANITIZED 1
#elif defined __has_feature
#define IS_SANITIZED (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer))
#else
#define IS_SANITIZED 0
#endif

enum { STREAMS = 3, MOST_BYTES = 1 << 17, MOST_TEXTS = 4096 };

typedef struct command_line {
    uint32_t words, variables, umask;
    char text[MOST_BYTES];
} command_line;

extern char **environ;
/* From a sanitizer's runtime, if there is one. */
void __lsan_do_leak_check(void) __attribute__((weak));
size_t __sanitizer_get_current_allocated_bytes(void) __attribute__((weak));
static command_line line;
static char *texts[MOST_TEXTS];

static bool receive(int channel, int streams[STREAMS])
{
    union {
        struct cmsghdr header;
        char bytes[CMSG_SPACE(STREAMS * sizeof(int))];
    } control;
    struct iovec data = {&line, sizeof line};
    struct msghdr message = {.msg_iov = &data,
                             .msg_iovlen = 1,
                             .msg_control = control.bytes,
                             .msg_controllen = sizeof control.bytes};
    ssize_t size;
    do
        size = recvmsg(channel, &message, 0);
    while (size < 0 && errno == EINTR);
    const struct cmsghdr *const found = size > 0 ? CMSG_FIRSTHDR(&message) : NULL;
    if (!found || found->cmsg_len != CMSG_LEN(STREAMS * sizeof(int)) || message.msg_flags & MSG_TRUNC)
        return false;
    memcpy(streams, CMSG_DATA(found), STREAMS * sizeof(int));
    return line.words + line.variables + 2 < MOST_TEXTS;
}

/* Splits the packet into texts, with a NULL after the words and after the variables. Returns the folder. */
static char *split(void)
{
    char *const folder = line.text, *at = folder + strlen(folder) + 1;
    for (uint32_t i = 0; i < line.words + line.variables + 1; i++) {
        if (i == line.words)
            continue;
        texts[i] = at;
        at += strlen(at) + 1;
    }
    return folder;
}

static int run_line(int channel, const int streams[STREAMS])
{
    char *const folder = split();
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL); /* giving up on a run kills the driver, so end with it */
#endif
    close(channel);
    for (int i = 0; i < STREAMS; i++)
        if (dup2(streams[i], i) < 0)
            return 125;
    for (int i = 0; i < STREAMS; i++)
        close(streams[i]);
    umask((mode_t)line.umask);
    environ = texts + line.words + 1;
    return chdir(folder) == 0 ? ffd_main((int)line.words, texts) : 125;
}

#if !IS_SANITIZED
/* Fills new memory as MALLOC_PERTURB_ does, to detect a dependence on the initial content of a block or on
   what follows it. But only this many bytes at each end: filling whole blocks would make memory resident that
   is never used. */
enum { FILLED = 4096 };
void *__libc_malloc(size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void __libc_free(void *block);

static void *fill(void *block, size_t size)
{
    return block ? memset(block, 0xA5, size < FILLED ? size : FILLED) : NULL;
}

void *malloc(size_t size)
{
    return fill(__libc_malloc(size), size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return fill(__libc_memalign(alignment, size), size);
}

void free(void *block)
{
    const int before = errno;
    if (block)
        fill(block, malloc_usable_size(block));
    __libc_free(block);
    errno = before;
}
#endif

static size_t allocated(void)
{
    return __sanitizer_get_current_allocated_bytes ? __sanitizer_get_current_allocated_bytes() : 0;
}

/* The leak check takes longer than most runs, so it is made only if more memory is allocated than expected.
   Destructors of libraries run as in the program itself. */
static _Noreturn void end(int code, size_t expected)
{
    fflush(NULL);
    if (__lsan_do_leak_check && allocated() != expected + __fbufsize(stdout))
        __lsan_do_leak_check();
    _exit(code);
}

int main(int argc, char **argv)
{
    int streams[STREAMS], status;
    const int channel = argc == 2 ? atoi(argv[1]) : -1;
    if (channel < STREAMS) {
        fprintf(stderr, "usage: driver SOCKET (a descriptor above 2)\n");
        return 2;
    }
    const size_t expected = allocated();
    while (receive(channel, streams)) {
        const pid_t child = fork();
        if (child == 0)
            end(run_line(channel, streams), expected);
        for (int i = 0; i < STREAMS; i++)
            close(streams[i]);
        while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR)
            continue;
        if (child < 0 || send(channel, &status, sizeof status, MSG_NOSIGNAL) != sizeof status)
            return 1;
    }
    return 0;
}
