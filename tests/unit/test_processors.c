/* test_processors.c - how many processors and how much memory a process may use: its affinity, and the limits
   of control groups, from the texts and files by which Linux tells of them. */
#define _GNU_SOURCE /* sched_setaffinity */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/system/cgroup.h"
#include "base/system/processors.h"
#include "base/system/thread.h"
#include <sched.h>
#include <sys/stat.h>

#include <errno.h>
#include <sys/syscall.h>

#define NONE CGROUP_UNLIMITED

/* Instead of that of the C library: shows a machine with other processors, if `shown` is set. */
static struct {
    size_t bits; /* of the system's mask; SIZE_MAX: there is none */
    int allowed;
    int calls;
} shown;

int sched_getaffinity(pid_t process, size_t size, cpu_set_t *set)
{
    shown.calls++;
    CPU_ZERO_S(size, set);
    if (shown.bits == 0)
        return syscall(SYS_sched_getaffinity, process, size, set) < 0 ? -1 : 0;
    if (size < shown.bits / 8) {
        errno = EINVAL;
        return -1;
    }
    for (int i = 0; i < shown.allowed; i++)
        CPU_SET_S(shown.bits - 1 - (size_t)i, size, set);
    return 0;
}

static void quotas_are_rounded_up_to_processors(void **state)
{
    static const struct {
        const char *text;
        uint64_t processors;
    } quotas[] = {
        {"max 100000", NONE},
        {"100000 100000", 1},
        {"100001 100000", 2},
        {"150000 100000", 2},
        {"200000 100000", 2},
        {"1000 100000", 1},
        {"1 1000000", 1},
        {"6400000 100000", 64},
        {"300000000 100000", 3000},
        {"-1 100000", NONE},
        {"18446744073709551614 1", UINT64_MAX - 1},
        {"18446744073709551614 18446744073709551614", 1},
        {"18446744073709551615 1", NONE},
        {"99999999999999999999999999 100000", NONE},
        {"100000 99999999999999999999999999", 1},
        {"0 100000", NONE},
        {"100000 0", NONE},
        {"100000", NONE},
        {"100000 ", NONE},
        {" 100000 100000", NONE},
        {"100000 100000 1", NONE},
        {"100000 100000x", NONE},
        {"1e5 100000", NONE},
        {"0x10 16", NONE},
        {"", NONE},
        {"max", NONE},
        {"maximum 100000", NONE},
    };
    (void)state;
    for (size_t i = 0; i < sizeof quotas / sizeof *quotas; i++)
        if (ffd_cgroup_processors(quotas[i].text) != quotas[i].processors)
            fail_msg("\"%s\": %llu processors", quotas[i].text,
                     (unsigned long long)ffd_cgroup_processors(quotas[i].text));
}

static void limits_of_memory_are_bytes(void **state)
{
    (void)state;
    assert_true(ffd_cgroup_bytes("0") == 0);
    assert_true(ffd_cgroup_bytes("268435456") == 268435456);
    assert_true(ffd_cgroup_bytes("max") == NONE);
    /* What version 1 says without a limit, with pages of 4 and of 64 KiB. */
    assert_true(ffd_cgroup_bytes("9223372036854771712") == NONE);
    assert_true(ffd_cgroup_bytes("9223372036854710272") == NONE);
    static const char *const broken[] = {"", "-1", "12 ", "12x", "x", "1e9", "99999999999999999999999999"};
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++)
        assert_true(ffd_cgroup_bytes(broken[i]) == NONE);
}

static void check_place(const char *text, const char *controllers, const char *path)
{
    char line[100];
    cgroup_place place;
    snprintf(line, sizeof line, "%s", text);
    const bool found = ffd_cgroup_place(line, &place);
    if (found != (path != NULL))
        fail_msg("%s: %d", text, found);
    if (!found)
        return;
    assert_string_equal(place.controllers, controllers);
    assert_string_equal(place.path, path);
}

static void a_process_is_in_a_group_of_each_hierarchy(void **state)
{
    (void)state;
    check_place("0::/user.slice/a.scope", "", "/user.slice/a.scope");
    check_place("0::/", "", "/");
    check_place("4:cpu,cpuacct:/a", "cpu,cpuacct", "/a");
    check_place("7:memory:/a:b", "memory", "/a:b");
    check_place("1:name=systemd:/a", "name=systemd", "/a");
    static const char *const broken[] = {"", "0", "0:", "0::", "0:/", "0::a", "::", "memory"};
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++)
        check_place(broken[i], NULL, NULL);
}

static void a_hierarchy_is_known_by_its_controllers(void **state)
{
    (void)state;
    assert_true(ffd_cgroup_controls("", ""));
    assert_false(ffd_cgroup_controls("", "cpu"));
    assert_true(ffd_cgroup_controls("cpu", "cpu"));
    assert_true(ffd_cgroup_controls("cpu,cpuacct", "cpu"));
    assert_true(ffd_cgroup_controls("cpuacct,cpu", "cpu"));
    assert_true(ffd_cgroup_controls("rw,cpuacct,cpu,xattr", "cpu"));
    assert_false(ffd_cgroup_controls("cpuacct,cpu", ""));
    assert_false(ffd_cgroup_controls("cpuset", "cpu"));
    assert_false(ffd_cgroup_controls("rw,cpuacct", "cpu"));
    assert_false(ffd_cgroup_controls("name=cpu", "cpu"));
    assert_false(ffd_cgroup_controls("cp", "cpu"));
    assert_false(ffd_cgroup_controls(",", ""));
    assert_false(ffd_cgroup_controls("rw,", ""));
}

static void check_mount(const char *text, const char *controllers, const char *root, const char *point)
{
    char line[300];
    cgroup_mount mount;
    snprintf(line, sizeof line, "%s", text);
    const bool found = ffd_cgroup_mount(line, &mount);
    if (found != (root != NULL))
        fail_msg("%s: %d", text, found);
    if (!found)
        return;
    assert_string_equal(mount.controllers, controllers);
    assert_string_equal(mount.root, root);
    assert_string_equal(mount.point, point);
}

static void mounts_are_found_among_others(void **state)
{
    (void)state;
    check_mount("30 24 0:26 / /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 rw,nsdelegate", "", "/",
                "/sys/fs/cgroup");
    check_mount("32 31 0:29 /docker/1 /sys/fs/cgroup/cpu ro master:9 propagate_from:2 - cgroup cgroup "
                "rw,cpu,cpuacct",
                "rw,cpu,cpuacct", "/docker/1", "/sys/fs/cgroup/cpu");
    check_mount("32 31 0:29 / /a\\040b\\134c rw - cgroup2 none rw", "", "/", "/a b\\c");
    check_mount("32 31 0:29 / /a\\04 rw - cgroup2 none rw", "", "/", "/a\\04");
    check_mount("32 31 0:29 / /a rw - cgroup2  rw", "", "/", "/a"); /* the source may be empty */
    check_mount("22 1 8:1 / / rw - ext4 /dev/sda1 rw,cpu", NULL, NULL, NULL);
    static const char *const broken[] = {"",
                                         "30",
                                         "30 24 0:26 / /sys/fs/cgroup rw cgroup2 cgroup2 rw",
                                         "30 24 0:26 / /sys/fs/cgroup rw - cgroup2",
                                         "30 24 0:26 / /sys/fs/cgroup rw - cgroup2 cgroup2",
                                         "30 24 0:26 / /sys/fs/cgroup rw - cgroup3 cgroup3 rw",
                                         "30 24 0:26 / /sys/fs/cgroup rw -",
                                         "30 24 0:26 a /sys/fs/cgroup rw - cgroup2 cgroup2 rw",
                                         "30 24 0:26 / sys/fs/cgroup rw - cgroup2 cgroup2 rw",
                                         "30 24 0:26 /",
                                         "30 - cgroup2 cgroup2 rw",
                                         "- cgroup2 cgroup2 rw - cgroup2"};
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++)
        check_mount(broken[i], NULL, NULL, NULL);
}

static void check_below(const char *root, const char *path, const char *below)
{
    const char *const found = ffd_cgroup_below(root, path);
    if ((!found != !below) || (below && strcmp(found, below) != 0))
        fail_msg("%s below %s: %s", path, root, found ? found : "not there");
}

static void a_group_stands_below_its_mount(void **state)
{
    (void)state;
    check_below("/", "/", "");
    check_below("/", "/a/b", "/a/b");
    check_below("/docker/1", "/docker/1", "");
    check_below("/docker/1", "/docker/1/", "");
    check_below("/docker/1", "/docker/1/a", "/a");
    /* Another group: */
    check_below("/docker/1", "/docker/12", NULL);
    check_below("/docker/1", "/docker", NULL);
    check_below("/docker/1", "/", NULL);
    /* Of a namespace that stands lower than the mount, and of a process outside of it: */
    check_below("/../..", "/a", "");
    check_below("/..", "/../b/c", "/b/c");
    check_below("/..", "/../../c", NULL);
    check_below("/", "/../b", NULL);
    check_below("/", "/a/..", NULL);
    check_below("/", "/..a/b..", "/..a/b..");
}

/* Writes the texts of a process. @ in them is the test's folder. */
static void describe(const char *cgroup, const char *mountinfo)
{
    char text[2000] = "", *to = text;
    mkdir(in_folder("self"), 0755);
    put_text("self/cgroup", cgroup);
    for (const char *at = mountinfo; *at; at++)
        if (*at == '@')
            to += sprintf(to, "%s", folder);
        else
            *to++ = *at;
    *to = 0;
    put_text("self/mountinfo", text);
}

/* Writes a limit in a folder below that of the test, which is made. */
static void limit(const char *where, const char *name, const char *text)
{
    char path[150];
    for (const char *slash = where; (slash = strchr(slash, '/')); slash++) {
        snprintf(path, sizeof path, "%.*s", (int)(slash - where), where);
        mkdir(in_folder(path), 0755);
    }
    mkdir(in_folder(where), 0755);
    snprintf(path, sizeof path, "%s/%s", where, name);
    put_text(path, text);
}

static void check_limits(uint64_t processors, uint64_t memory)
{
    const char *const process = in_folder("self");
    assert_int_equal(ffd_cgroup_processor_limit(process), processors);
    assert_int_equal(ffd_cgroup_memory_limit(process), memory);
}

/* Removes everything that a test has written. */
static int clear(void **state)
{
    return remove_folder(state) || mkdir(folder, 0700);
}

#define OTHERS "22 1 8:1 / / rw,relatime shared:1 - ext4 /dev/sda1 rw\n23 22 0:21 / /proc rw - proc proc rw\n"

static void the_least_limit_up_to_the_mount_counts(void **state)
{
    (void)state;
    describe("0::/a/b/c\n", OTHERS "30 24 0:26 / @/two rw - cgroup2 cgroup2 rw\n");
    check_limits(NONE, NONE);
    limit("two/a/b/c", "cpu.max", "max 100000\n");
    limit("two/a/b/c", "memory.max", "3000000\n");
    check_limits(NONE, 3000000);
    limit("two/a", "cpu.max", "250000 100000\n");
    limit("two/a/b", "memory.max", "max\n");
    limit("two/a", "memory.max", "2000000\n");
    check_limits(3, 2000000);
    limit("two/a/b/c", "cpu.max", "400000 100000\n");
    limit("two/a/b/d", "cpu.max", "1000 100000\n"); /* of another process */
    limit("", "cpu.max", "1000 100000\n");          /* above the mount */
    check_limits(3, 2000000);
    limit("two", "cpu.max", "50000 100000\n");
    limit("two", "memory.max", "1000000\n");
    check_limits(1, 1000000);
}

static void the_controllers_of_version_1_are_mounted_apart(void **state)
{
    (void)state;
    describe("4:memory:/m/n\n3:cpuset:/\n2:cpu,cpuacct:/c\n1:name=systemd:/x\n",
             OTHERS "32 31 0:29 / @/cpu rw - cgroup cgroup rw,cpu,cpuacct\n"
                    "33 31 0:30 / @/cpuset rw - cgroup cgroup rw,cpuset\n"
                    "35 31 0:32 / @/memory rw - cgroup cgroup rw,memory\n");
    limit("cpu", "cpu.cfs_quota_us", "-1\n");
    limit("cpu", "cpu.cfs_period_us", "100000\n");
    limit("memory", "memory.limit_in_bytes", "9223372036854771712\n");
    check_limits(NONE, NONE);
    limit("cpu/c", "cpu.cfs_quota_us", "50000\n");
    check_limits(NONE, NONE); /* without the period */
    limit("cpu/c", "cpu.cfs_period_us", "20000\n");
    limit("memory/m/n", "memory.limit_in_bytes", "9223372036854771712\n");
    limit("memory/m", "memory.limit_in_bytes", "7000000\n");
    check_limits(3, 7000000);
    limit("cpu/c", "cpu.max", "10000 100000\n"); /* of the other version */
    limit("cpuset", "cpu.cfs_quota_us", "1000\n");
    limit("cpuset", "cpu.cfs_period_us", "1000\n");
    check_limits(3, 7000000);
}

static void controllers_of_both_versions_may_be_mounted(void **state)
{
    (void)state;
    describe("2:cpu:/c\n1:name=systemd:/s\n0::/s\n", OTHERS
             "32 31 0:29 / @/cpu rw - cgroup cgroup rw,cpu\n41 31 0:38 / @/two rw - cgroup2 cgroup2 rw\n");
    limit("cpu/c", "cpu.cfs_quota_us", "400000\n");
    limit("cpu/c", "cpu.cfs_period_us", "100000\n");
    limit("two/s", "memory.max", "5000000\n");
    check_limits(4, 5000000);
    limit("two/s", "cpu.max", "200000 100000\n");
    check_limits(2, 5000000);
}

/* What containers see. */
static void a_namespace_shows_a_part_of_a_hierarchy(void **state)
{
    (void)state;
    /* The namespace's root is the mount's. */
    describe("0::/\n", "30 24 0:26 / @/two ro - cgroup2 cgroup rw\n");
    limit("two", "cpu.max", "200000 100000\n");
    limit("two", "memory.max", "4000000\n");
    check_limits(2, 4000000);
    /* No namespace, but only the own group is mounted. */
    describe("0::/docker/1/job\n", "30 24 0:26 /docker/1 @/two ro - cgroup2 cgroup rw\n");
    check_limits(2, 4000000);
    limit("two/job", "cpu.max", "100000 100000\n");
    check_limits(1, 4000000);
    /* The path is that of the host: no such folder is there. */
    describe("0::/lxc/1\n", "30 24 0:26 / @/two ro - cgroup2 cgroup rw\n");
    check_limits(2, 4000000);
    /* A mount that was made outside of the namespace shows more than it. */
    describe("0::/job\n", "30 24 0:26 /../.. @/two ro - cgroup2 cgroup rw\n");
    check_limits(2, 4000000);
    /* The groups of others only. */
    describe("0::/docker/1\n", "30 24 0:26 /docker/2 @/two ro - cgroup2 cgroup rw\n");
    check_limits(NONE, NONE);
    describe("0::/../2\n", "30 24 0:26 / @/two ro - cgroup2 cgroup rw\n");
    check_limits(NONE, NONE);
}

static void of_several_mounts_the_one_that_shows_most_counts(void **state)
{
    static const char whole[] = "30 24 0:26 / @/whole rw - cgroup2 cgroup rw\n",
                      part[] = "31 24 0:26 /a @/part rw - cgroup2 cgroup rw\n",
                      other[] = "32 24 0:26 /b @/other rw - cgroup2 cgroup rw\n";
    (void)state;
    limit("whole", "memory.max", "1000000\n");
    limit("whole/a", "memory.max", "3000000\n");
    limit("part", "memory.max", "3000000\n");
    limit("other", "memory.max", "500000\n");
    const char *const orders[][3] = {{whole, part, other}, {other, part, whole}, {part, other, whole}};
    for (int i = 0; i < 3; i++) {
        char text[500];
        snprintf(text, sizeof text, "%s%s%s", orders[i][0], orders[i][1], orders[i][2]);
        describe("0::/a\n", text);
        check_limits(NONE, 1000000);
    }
    /* The later of two at one place hides the earlier. */
    describe("0::/a\n", "30 24 0:26 / @/whole rw - cgroup2 cgroup rw\n"
                        "33 24 0:26 / @/other rw - cgroup2 cgroup rw\n");
    check_limits(NONE, 500000);
}

static void what_cannot_be_read_is_no_limit(void **state)
{
    static char long_line[20000];
    (void)state;
    check_limits(NONE, NONE); /* no /proc */
    describe("0::/a\n", "30 24 0:26 / @/two rw - cgroup2 cgroup rw\n");
    check_limits(NONE, NONE); /* nothing is mounted there */
    limit("two/a/memory.max", "x", "");
    limit("two/a/cpu.max", "x", "");
    limit("two", "memory.max", "1000000");
    limit("two", "cpu.max", "200000 100000");
    check_limits(2, 1000000); /* folders in place of files; no line break at the end */
    limit("two", "cpu.max", "200000 100000\n100000 100000\n");
    limit("two", "memory.max", "");
    check_limits(2, NONE);
    memset(long_line, '1', sizeof long_line - 1);
    limit("two", "memory.max", long_line);
    check_limits(2, NONE);
    memset(long_line, 'x', sizeof long_line - 1);
    memcpy(long_line + 9000, "\n0::/a", 6);
    put_text("self/cgroup", long_line);
    check_limits(NONE, NONE); /* the path of the group is too long */
    memcpy(long_line + 9006, "\n", 1);
    put_text("self/cgroup", long_line);
    check_limits(2, NONE); /* lines that are too long are passed over */
    put_text("self/cgroup", "");
    check_limits(NONE, NONE);
    put("self/cgroup", "\0\0\0\n0::/a\n\xff\xfe", 13);
    put("self/mountinfo", "\0\n\xff\n", 4);
    check_limits(NONE, NONE);
}

/* More than one processor is there on most machines only. */
static void the_affinity_of_the_thread_counts(void **state)
{
    cpu_set_t all[8], one;
    int first = 0;
    (void)state;
    assert_int_equal(sched_getaffinity(0, sizeof all, all), 0);
    const int before = ffd_processor_count();
    assert_in_range(before, 1, CPU_COUNT_S(sizeof all, all));
    while (!CPU_ISSET_S(first, sizeof all, all))
        first++;
    if (first < CPU_SETSIZE) {
        CPU_ZERO(&one);
        CPU_SET(first, &one);
        assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
        assert_int_equal(ffd_processor_count(), 1);
    }
    assert_int_equal(sched_setaffinity(0, sizeof all, all), 0);
    assert_int_equal(ffd_processor_count(), before);
}

static void machines_may_have_thousands_of_processors(void **state)
{
    static const int counts[] = {1, 1023, 1024, 1025, 1500, 8192, 9000, 65536};
    const uint64_t limit = ffd_cgroup_processor_limit(CGROUP_SELF);
    (void)state;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        shown.allowed = counts[i];
        for (shown.bits = 1024; shown.bits <= 65536; shown.bits *= 2)
            if (shown.bits >= (size_t)counts[i])
                assert_int_equal(ffd_processor_count(),
                                 (uint64_t)counts[i] < limit ? (uint64_t)counts[i] : limit);
    }
    shown.bits = SIZE_MAX;
    const long online = sysconf(_SC_NPROCESSORS_ONLN);
    assert_int_equal(ffd_processor_count(), (uint64_t)online < limit ? (uint64_t)online : limit);
    shown.bits = 0;
}

static void one_piece_of_work_does_not_count_the_processors(void **state)
{
    const uint64_t limit = ffd_cgroup_processor_limit(CGROUP_SELF);
    const int most = limit < 5 ? (int)limit : 5;
    ffd_error error;
    (void)state;
    shown.allowed = 5;
    shown.bits = 1024;
    shown.calls = 0;
    assert_int_equal(ffd_threads_for(0, 0), 1);
    assert_int_equal(ffd_threads_for(0, 1), 1);
    assert_int_equal(ffd_threads_for(7, 1), 1);
    assert_int_equal(ffd_threads_for_bytes(0, 0), 1);
    assert_int_equal(ffd_threads_for_bytes(0, 131071), 1);
    assert_int_equal(ffd_threads_for(7, 8), 7);
    assert_int_equal(ffd_threads_for(7, 6), 6);
    assert_int_equal(shown.calls, 0);
    assert_int_equal(ffd_threads_for(0, UINT64_MAX), most);
    assert_int_equal(ffd_threads_for(0, 2), most < 2 ? most : 2);
    assert_int_equal(ffd_threads_for_bytes(0, 131072), most < 2 ? most : 2);
    assert_int_equal(ffd_threads_for_bytes(0, UINT64_MAX), most);
    assert_int_equal(shown.calls, 4);
    shown.bits = 0;
    assert_int_equal(ffd_threads_check(0, &error), FFD_OK);
    assert_int_equal(ffd_threads_check(3, &error), FFD_OK);
    assert_int_equal(ffd_threads_check(-1, &error), FFD_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quotas_are_rounded_up_to_processors),
        cmocka_unit_test(limits_of_memory_are_bytes),
        cmocka_unit_test(a_process_is_in_a_group_of_each_hierarchy),
        cmocka_unit_test(a_hierarchy_is_known_by_its_controllers),
        cmocka_unit_test(mounts_are_found_among_others),
        cmocka_unit_test(a_group_stands_below_its_mount),
        cmocka_unit_test_teardown(the_least_limit_up_to_the_mount_counts, clear),
        cmocka_unit_test_teardown(the_controllers_of_version_1_are_mounted_apart, clear),
        cmocka_unit_test_teardown(controllers_of_both_versions_may_be_mounted, clear),
        cmocka_unit_test_teardown(a_namespace_shows_a_part_of_a_hierarchy, clear),
        cmocka_unit_test_teardown(of_several_mounts_the_one_that_shows_most_counts, clear),
        cmocka_unit_test_teardown(what_cannot_be_read_is_no_limit, clear),
        cmocka_unit_test(the_affinity_of_the_thread_counts),
        cmocka_unit_test(machines_may_have_thousands_of_processors),
        cmocka_unit_test(one_piece_of_work_does_not_count_the_processors),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
