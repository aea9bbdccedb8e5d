/* measure_peak.c - measure_peak FILE PROGRAM ARGUMENT...: runs a program and writes its exit code (minus the
   signal that ended it) and the peak of its memory in bytes to a file.

   The peak of a process begins with what it had in memory before it became another program: this one has
   little, in a tenth of the time that an interpreter takes to start. */
#include <stdio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

int main(int argc, char **argv)
{
    int status;
    struct rusage usage;
    if (argc < 3)
        return 2;
    const pid_t child = fork();
    if (child == 0) {
        execv(argv[2], argv + 2);
        _exit(127);
    }
    if (child < 0 || waitpid(child, &status, 0) != child || getrusage(RUSAGE_CHILDREN, &usage))
        return 1;
    FILE *const file = fopen(argv[1], "w");
    if (!file)
        return 1;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    const int written = fprintf(file, "%d %lld\n", code, 1024LL * usage.ru_maxrss);
    return fclose(file) || written < 0;
}
