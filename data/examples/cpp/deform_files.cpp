// deform_files LATTICE FOLDER MESH...: deforms meshes into a folder, with a report, and none that would fold.
#include <cstdio>
#include <ffd/ffd.h>
#include <filesystem>

// What all jobs share: a record of what was written, and the report.
struct Run {
    ffd_output_set *output_set = nullptr;
    ffd_report *report = nullptr;
    ~Run() { ffd_report_destroy(&report), ffd_output_set_destroy(&output_set); }
};

// Calls a function that takes an ffd_error last, and throws it.
template <typename Function, typename... Arguments> void call(Function *function, Arguments... arguments)
{
    ffd_error error;
    if (function(arguments..., &error) != FFD_OK)
        throw error;
}

// Returns whether the mesh was written. One that fails does not stop the others.
static bool deform(const Run &run, const char *lattice, const char *mesh, const std::filesystem::path &output)
{
    ffd_deform_desc desc;
    ffd_deform_desc_init(&desc, sizeof desc);
    desc.input.path = mesh;
    desc.output = output.c_str();
    const ffd_lattice_source source = {lattice, {}, nullptr};
    desc.lattices = &source, desc.lattice_count = 1;
    desc.fail_on = FFD_GATE_FOLDS;    // nothing is written unless the volume is proven to be free of folds
    desc.force = true;                // replaces what an earlier run wrote, ...
    desc.output_set = run.output_set; // ... and never what this one did
    ffd_job_result result = {};
    result.struct_size = sizeof result;
    ffd_error error;
    const bool done = ffd_deform_run(&desc, &result, &error) == FFD_OK;
    std::fprintf(done ? stdout : stderr, "%s: %s\n", mesh, done ? desc.output : error.message);
    call(ffd_report_add, run.report, mesh, desc.output, &result);
    return done;
}

int main(int argc, char **argv)
try {
    if (argc < 4)
        return std::fprintf(stderr, "usage: deform_files LATTICE FOLDER MESH...\n"), 2;
    const std::filesystem::path folder = argv[2];
    Run run;
    bool ok = true;
    call(ffd_output_set_create, &run.output_set);
    call(ffd_report_create, (folder / "report.json").c_str(), false, run.output_set, &run.report);
    for (char **mesh = argv + 3; *mesh; mesh++)
        ok &= deform(run, argv[1], *mesh, folder / std::filesystem::path(*mesh).filename());
    call(ffd_report_write, run.report);
    return ok ? 0 : 1;
} catch (const ffd_error &error) {
    char line[2048];
    ffd_error_format(&error, line, sizeof line);
    std::fprintf(stderr, "deform_files: %s\n", line);
    return ffd_status_exit_code(error.status);
}
