#include "cli/author.h"
#include <stdlib.h>
#include <string.h>

/* A setter: one more mesh. */
static bool add_mesh(void *context, const cli_option *option, const char *value)
{
    cli_author *const author = context;
    if (!*value) {
        cli_complain("--%s is empty", option->name);
        return false;
    }
    ffd_source *const meshes = realloc(author->meshes, (author->mesh_count + 1) * sizeof *meshes);
    if (!meshes) {
        cli_complain("out of memory");
        return false;
    }
    meshes[author->mesh_count++] = (ffd_source){.path = value};
    author->meshes = meshes;
    return true;
}

#define AT(field) offsetof(cli_author, field)
const cli_option cli_author_options[] = {
    {"output", 'o', "LATTICE", "the file to write; -: standard output", cli_set_text, AT(output), NULL},
    {"set", 0, "NAME=VALUE", "value of the placeholder {\"$\": \"NAME\"} in the moves; repeatable",
     cli_set_member, AT(job), NULL},
    {"mesh", 0, "MESH", "lay the lattice's \"box\": \"mesh\" round this, repeatable", add_mesh, 0, NULL},
    {"only", 0, "KIND:NAME", "with --mesh: round this only, repeatable, as for ffd lattice new",
     cli_set_member, AT(job), NULL},
    {"space", 0, "scene|mesh", "with --mesh, glTF: the space that the lattice is in; default scene",
     cli_set_member, AT(job), NULL},
    {"threads", 'j', "N",
     "number of threads, 1 to 1024; never changes the output; default all usable processors", cli_set_member,
     AT(job), NULL},
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
    for (size_t i = 0; i < author->mesh_count; i++)
        if (strcmp(author->meshes[i].path, "-") == 0)
            return "--mesh names a file, not standard input";
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

void cli_author_end(cli_author *author)
{
    free(author->meshes);
    ffd_deform_desc_clear(&author->job);
}
