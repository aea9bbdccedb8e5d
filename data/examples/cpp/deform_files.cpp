// deform_files.cpp - whole jobs: every mesh is deformed into a folder, and refused where that would fold it.
//
//     deform_files LATTICE FOLDER MESH...
//
// What happened is printed for people and written to FOLDER/report.json for programs.
#include <cstdio>
#include <ffd/ffd.h>
#include <memory>
#include <stdexcept>
#include <string>

namespace
{

// What the library gives us is ours to destroy: a unique_ptr does. Its functions take the pointer's address.
struct Destroy {
    void operator()(ffd_report *report) const { ffd_report_destroy(&report); }
    void operator()(ffd_written *written) const { ffd_written_destroy(&written); }
};
using Report = std::unique_ptr<ffd_report, Destroy>;
using Written = std::unique_ptr<ffd_written, Destroy>;

// A failure as an exception.
void check(ffd_status status, const ffd_error &error)
{
    if (status == FFD_OK)
        return;
    char line[2048];
    ffd_error_format(&error, line, sizeof line);
    throw std::runtime_error(line);
}

// Takes what the library has to say of one mesh; user is what was given to the job beside this function.
void say(void *user, ffd_log_level level, const char *line)
{
    if (level == FFD_LOG_WARNING)
        std::fprintf(stderr, "%s: %s\n", static_cast<const char *>(user), line);
}

std::string in_folder(const std::string &folder, const std::string &path)
{
    return folder + "/" + path.substr(path.find_last_of('/') + 1);
}

// Returns whether the mesh was written. A mesh that fails does not stop the others.
bool deform(const char *lattice, const std::string &folder, char *mesh, ffd_written *written,
            ffd_report *report)
{
    const std::string output = in_folder(folder, mesh);
    ffd_deform_desc desc;
    ffd_deform_desc_init(&desc, sizeof desc);
    desc.input.path = mesh;
    desc.output = output.c_str();
    desc.lattices = &lattice;
    desc.lattice_count = 1;
    desc.quality = true;           // count the faces that turn over, for the report
    desc.fail_on = FFD_GATE_FOLDS; // nothing is written unless the volume is proven to be free of folds
    desc.force = true;             // replaces what an earlier run wrote, ...
    desc.written = written;        // ... and never what this one did
    desc.log = say;
    desc.log_user = mesh;

    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    if (ffd_deform_run(&desc, &result, &error) == FFD_OK)
        std::printf("%s: %llu of %llu vertices moved, by %g at most\n", output.c_str(),
                    static_cast<unsigned long long>(result.moved),
                    static_cast<unsigned long long>(result.vertices), result.displacement_max);
    else
        std::fprintf(stderr, "%s: %s\n", mesh, result.error.message);
    check(ffd_report_add(report, mesh, output.c_str(), &result, &error), error);
    return result.status == FFD_OK;
}

int run(const char *lattice, const std::string &folder, char **meshes)
{
    ffd_error error;
    ffd_written *new_written = nullptr;
    check(ffd_written_create(&new_written, &error), error);
    const Written written(new_written);
    ffd_report *new_report = nullptr;
    check(ffd_report_create((folder + "/report.json").c_str(), false, written.get(), &new_report, &error),
          error);
    const Report report(new_report);

    int failed = 0;
    for (; *meshes; meshes++)
        failed += !deform(lattice, folder, *meshes, written.get(), report.get());
    check(ffd_report_write(report.get(), &error), error);
    return failed ? 1 : 0;
}

} // namespace

int main(int argc, char **argv)
{
    if (argc < 4) {
        std::fprintf(stderr, "usage: deform_files LATTICE FOLDER MESH...\n");
        return 2;
    }
    try {
        return run(argv[1], argv[2], argv + 3);
    } catch (const std::exception &failure) {
        std::fprintf(stderr, "deform_files: %s\n", failure.what());
        return 1;
    }
}
