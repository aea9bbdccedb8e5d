#include "cli/author.h"
#include "cli/files.h"
#include <stdlib.h>
#include <string.h>

/* A setter: one more mesh. */
static bool add_mesh(void *context, const cli_option *option, const char *value)
{
    cli_author *const author = context;
    return cli_add_file(&author->meshes, &author->mesh_count, option, value);
}

#define AT(field) offsetof(cli_author, field)
const cli_option cli_author_options[] = {
    {"output", 'o', "LATTICE", "the file to write; -: standard output", cli_set_text, AT(output), NULL},
    {"set", 0, "NAME=VALUE", "value of the placeholder {\"$\": \"NAME\"} in the moves; repeatable",
     cli_set_member, AT(job), NULL},
    {"time", 0, "T", "of a lattice that has keys: what it is at T seconds, between them", cli_set_member,
     AT(job), NULL},
    {"mesh", 0, "MESH", "lay the lattice's \"box\": \"mesh\" round this, repeatable", add_mesh, 0, NULL},
    {"only", 0, "KIND:NAME", "with --mesh: round this only, repeatable, as for ffd lattice new",
     cli_set_member, AT(job), NULL},
    {"space", 0, "scene|mesh", "with --mesh, glTF: the space that the lattice is in; default scene",
     cli_set_member, AT(job), NULL},
    {"threads", 'j', "N", CLI_THREADS, cli_set_member, AT(job), NULL},
    {"force", 0, NULL, "overwrite an existing file", cli_set_member, AT(job), NULL},
    {"memory", 0, "SIZE", CLI_MEMORY, cli_set_member, AT(job), NULL},
    {"strict", 0, NULL, CLI_STRICT, cli_set_member, AT(job), NULL},
    {"quiet", 'q', NULL, "only errors", cli_set_flag, AT(logging.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(logging.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

const char *cli_author_mistake(const cli_author *author, const cli_words *words)
{
    if (words->count != 1)
        return "needs one LATTICE";
    if (!author->output)
        return "no output is given (-o LATTICE)";
    if (author->mesh_count == 0 && author->job.only_count > 0)
        return "--only needs --mesh";
    return NULL;
}

bool cli_author_prepare(cli_author *author)
{
    for (size_t i = 0; i < author->mesh_count; i++) {
        const char *const path = author->meshes[i].path;
        if (!cli_knows_format(path, FFD_FORMAT_AUTO))
            return false;
        author->meshes[i] = author->job.input;
        author->meshes[i].path = path;
    }
    return true;
}

ffd_author_desc cli_author_describe(const cli_author *author, const char *lattice)
{
    ffd_author_desc desc;
    ffd_author_desc_init(&desc, sizeof desc);
    desc.lattice.path = lattice;
    desc.set = author->job.set;
    desc.set_count = author->job.set_count;
    desc.time = author->job.time;
    desc.has_time = author->job.has_time;
    desc.meshes = author->meshes;
    desc.mesh_count = author->mesh_count;
    desc.only = author->job.only;
    desc.only_count = author->job.only_count;
    desc.reading = author->job.input;
    desc.threads = author->job.threads;
    desc.output = author->output;
    desc.force = author->job.force;
    desc.log = cli_log;
    desc.log_user = (void *)&author->logging;
    return desc;
}

void cli_author_end(cli_author *author)
{
    free(author->meshes);
    ffd_deform_desc_clear(&author->job);
}
