/* json_oracle.h - what another reader of JSON (nlohmann's) says of a report, to judge ours by. */
#ifndef FFD_TESTS_FUZZ_JSON_ORACLE_H
#define FFD_TESTS_FUZZ_JSON_ORACLE_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct json_oracle json_oracle;

/* Reads a text; free with oracle_free. NULL: it is not JSON, or has a key twice in an object; or, with
 *too_large, a number that a double cannot hold, which is JSON all the same. */
json_oracle *oracle_read(const char *text, size_t size, bool *too_large);
void oracle_free(json_oracle *oracle);
/* Whether it has the members of a report, and each job says what it must. */
bool oracle_is_report(const json_oracle *oracle);
/* Of a report: its jobs, and whether one of them is this value. */
size_t oracle_count_jobs(const json_oracle *oracle);
bool oracle_job_is(const json_oracle *oracle, size_t job, const json_oracle *value);

#ifdef __cplusplus
}
#endif

#endif
