/* gltf_tinygltf.cpp - the only source that includes tinygltf, compiled with macros that leave out image
   codecs and file access. */
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_model.h"
#include <cstring>
#include <fstream> /* tinygltf leaves it out, but has functions that write, and that nobody calls */
#include <new>
#include <type_traits>

/* Renamed: a program that links the static library may have its own tinygltf. */
#define tinygltf ffd_tinygltf
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_INCLUDE_JSON
#include "io/gltf/read/json_reserve.h"
#include <tiny_gltf.h>

namespace
{

/* Allocates a C array of count elements, which ffd_gltf_free_model frees. */
template <typename T> T *make_array(size_t count)
{
    T *array = static_cast<T *>(ffd_alloc_zero(count, sizeof(T)));
    if (!array)
        throw std::bad_alloc();
    return array;
}

gltf_semantic semantic_of(const std::string &name)
{
    return name == "POSITION"  ? GLTF_POSITION
           : name == "NORMAL"  ? GLTF_NORMAL
           : name == "TANGENT" ? GLTF_TANGENT
                               : GLTF_OTHER;
}

gltf_view to_c(const tinygltf::BufferView &from)
{
    gltf_view to = {};
    to.buffer = from.buffer;
    to.offset = from.byteOffset;
    to.length = from.byteLength;
    to.stride = from.byteStride;
    return to;
}

gltf_accessor to_c(const tinygltf::Accessor &from)
{
    gltf_accessor to = {};
    to.view = from.bufferView;
    to.offset = from.byteOffset;
    to.count = from.count;
    to.component = from.componentType;
    to.normalized = from.normalized;
    const bool matrix =
        from.type == TINYGLTF_TYPE_MAT2 || from.type == TINYGLTF_TYPE_MAT3 || from.type == TINYGLTF_TYPE_MAT4;
    const int components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(from.type));
    to.columns = !matrix ? 1 : components == 4 ? 2 : components == 9 ? 3 : 4;
    to.rows = components / to.columns;
    to.sparse.present = from.sparse.isSparse;
    if (from.sparse.isSparse) {
        to.sparse.count = static_cast<uint64_t>(from.sparse.count);
        to.sparse.indices_view = from.sparse.indices.bufferView;
        to.sparse.indices_offset = static_cast<uint64_t>(from.sparse.indices.byteOffset);
        to.sparse.indices_type = from.sparse.indices.componentType;
        to.sparse.values_view = from.sparse.values.bufferView;
        to.sparse.values_offset = static_cast<uint64_t>(from.sparse.values.byteOffset);
    }
    return to;
}

int attribute_of(const tinygltf::Primitive &primitive, const std::string &name)
{
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
}

void influences_to_c(const tinygltf::Primitive &from, gltf_primitive &to)
{
    to.influences = make_array<gltf_influence>(from.attributes.size());
    for (;;) {
        const std::string set = std::to_string(to.influence_count);
        const gltf_influence next = {attribute_of(from, "JOINTS_" + set),
                                     attribute_of(from, "WEIGHTS_" + set)};
        if (next.joints < 0 && next.weights < 0)
            break;
        to.influences[to.influence_count++] = next;
    }
}

void to_c(const tinygltf::Primitive &from, gltf_primitive &to)
{
    to.indices = from.indices;
    to.mode = from.mode;
    for (int &accessor : to.accessor)
        accessor = -1;
    to.attributes = make_array<gltf_attribute>(from.attributes.size());
    for (const auto &attribute : from.attributes) {
        const gltf_semantic semantic = semantic_of(attribute.first);
        to.attributes[to.attribute_count++] = {semantic, attribute.second};
        if (semantic != GLTF_OTHER)
            to.accessor[semantic] = attribute.second;
    }
    influences_to_c(from, to);
    size_t target_attributes = 0;
    for (const auto &target : from.targets)
        target_attributes += target.size();
    to.targets = make_array<gltf_attribute>(target_attributes);
    to.target_count = from.targets.size();
    to.target_accessors = make_array<int>(GLTF_DEFORMED * from.targets.size());
    size_t slot = 0;
    for (const auto &target : from.targets) {
        for (size_t s = 0; s < GLTF_DEFORMED; s++)
            to.target_accessors[slot + s] = -1;
        for (const auto &attribute : target) {
            const gltf_semantic semantic = semantic_of(attribute.first);
            to.targets[to.target_attribute_count++] = {semantic, attribute.second};
            if (semantic != GLTF_OTHER)
                to.target_accessors[slot + semantic] = attribute.second;
        }
        slot += GLTF_DEFORMED;
    }
}

void to_c(const std::vector<tinygltf::Mesh> &from, gltf_model &to)
{
    size_t primitives = 0;
    for (const auto &mesh : from)
        primitives += mesh.primitives.size();
    to.meshes = make_array<gltf_mesh>(from.size());
    to.primitives = make_array<gltf_primitive>(primitives);
    for (const auto &mesh : from) {
        gltf_mesh &made = to.meshes[to.mesh_count];
        made.primitives = to.primitives + to.primitive_count;
        made.primitive_count = mesh.primitives.size();
        for (const auto &primitive : mesh.primitives) {
            gltf_primitive &next = to.primitives[to.primitive_count++];
            next.mesh = to.mesh_count;
            next.index = static_cast<size_t>(&next - made.primitives);
            to_c(primitive, next);
        }
        to.mesh_count++;
    }
}

void copy_numbers(const std::vector<double> &from, size_t count, double *to)
{
    if (from.size() == count)
        std::memcpy(to, from.data(), count * sizeof *to);
}

int *copy_indices(const std::vector<int> &from)
{
    int *to = make_array<int>(from.size());
    if (!from.empty())
        std::memcpy(to, from.data(), from.size() * sizeof *to);
    return to;
}

void to_c(const tinygltf::Node &from, gltf_node &to)
{
    to.mesh = from.mesh;
    to.skin = from.skin;
    to.has_matrix = !from.matrix.empty();
    to.rotation[3] = 1;
    to.scale[0] = to.scale[1] = to.scale[2] = 1;
    copy_numbers(from.matrix, 16, to.matrix);
    copy_numbers(from.translation, 3, to.translation);
    copy_numbers(from.rotation, 4, to.rotation);
    copy_numbers(from.scale, 3, to.scale);
    to.children = copy_indices(from.children);
    to.child_count = from.children.size();
}

void to_c(const tinygltf::Model &from, gltf_model &to)
{
    to.scene = from.defaultScene;
    to.views = make_array<gltf_view>(from.bufferViews.size());
    for (const auto &view : from.bufferViews)
        to.views[to.view_count++] = to_c(view);
    to.accessors = make_array<gltf_accessor>(from.accessors.size());
    for (const auto &accessor : from.accessors)
        to.accessors[to.accessor_count++] = to_c(accessor);
    to_c(from.meshes, to);
    to.nodes = make_array<gltf_node>(from.nodes.size());
    for (const auto &node : from.nodes)
        to_c(node, to.nodes[to.node_count++]);
    to.scenes = make_array<gltf_scene>(from.scenes.size());
    for (const auto &scene : from.scenes) {
        gltf_scene &made = to.scenes[to.scene_count++];
        made.nodes = copy_indices(scene.nodes);
        made.node_count = scene.nodes.size();
    }
}

bool never_exists(const std::string &, void *)
{
    return false;
}

std::string never_expanded(const std::string &path, void *)
{
    return path;
}

bool never_read(std::vector<unsigned char> *, std::string *, const std::string &, void *)
{
    return false;
}

bool never_written(std::string *, const std::string &, const std::vector<unsigned char> &, void *)
{
    return false;
}

/* Version 2.9 asks for the size of a file before it reads it. The second one is for older versions. */
template <typename Callbacks>
auto refuse_size(Callbacks &callbacks, int) -> decltype(callbacks.GetFileSizeInBytes, void())
{
    callbacks.GetFileSizeInBytes = [](size_t *, std::string *, const std::string &, void *) { return false; };
}

template <typename Callbacks> void refuse_size(Callbacks &, long) {}

/* Version 2.9 returns whether it accepts the callbacks: only if it knows all of them. */
template <typename Reader> bool set_callbacks(Reader &reader, const tinygltf::FsCallbacks &callbacks)
{
    if constexpr (std::is_void_v<decltype(reader.SetFsCallbacks(callbacks))>) {
        reader.SetFsCallbacks(callbacks);
        return true;
    } else {
        return reader.SetFsCallbacks(callbacks);
    }
}

/* Keeps tinygltf from every file: it has no functions for them (TINYGLTF_NO_FS), and these refuse all. */
bool refuse_files(tinygltf::TinyGLTF &reader)
{
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = never_exists;
    callbacks.ExpandFilePath = never_expanded;
    callbacks.ReadWholeFile = never_read;
    callbacks.WriteWholeFile = never_written;
    refuse_size(callbacks, 0);
    return set_callbacks(reader, callbacks);
}

/* An upper bound of the number of values in the JSON. */
size_t count_values(const char *text, size_t size)
{
    size_t count = 1;
    for (size_t i = 0; i < size; i++)
        count += text[i] == ',' || text[i] == '[' || text[i] == '{';
    return count;
}

/* Returns an upper bound of the memory of vectors. A vector that doubles its capacity takes at most twice
   what it holds, and all its blocks together at most twice that; all this once for parsing and once for
   destruction. */
size_t reserve_size(const char *text, size_t size)
{
    return 8 * sizeof(nlohmann::json) * count_values(text, size);
}

ffd_status parse(const char *text, size_t size, const char *name, gltf_model *model, ffd_error *error)
{
    const json_reserve reserve(reserve_size(text, size));
    tinygltf::TinyGLTF reader;
    if (!refuse_files(reader))
        return ffd_fail_file(
            error, FFD_E_UNSUPPORTED, name,
            "glTF cannot be read: this tinygltf has callbacks for files that ffd does not know");
    tinygltf::Model read;
    std::string problems, warnings;
    if (!reader.LoadASCIIFromString(&read, &problems, &warnings, text, static_cast<unsigned int>(size), "",
                                    tinygltf::REQUIRE_VERSION)) {
        const std::string first = problems.substr(0, problems.find('\n'));
        /* tinygltf keeps only the message of an exception, not its type. */
        if (first == std::bad_alloc().what())
            throw std::bad_alloc();
        return ffd_fail_file(error, FFD_E_INVALID, name, "is not valid glTF: %s",
                             first.empty() ? "tinygltf refuses it" : first.c_str());
    }
    to_c(read, *model);
    return FFD_OK;
}

} // namespace

extern "C" ffd_status ffd_gltf_parse_model(const char *text, size_t size, const char *name, gltf_model *model,
                                           ffd_error *error)
{
    *model = {};
    ffd_status status;
    try {
        status = parse(text, size, name, model, error);
    } catch (const std::bad_alloc &) {
        status = ffd_fail_memory(error);
    } catch (const std::exception &problem) {
        status = ffd_fail_file(error, FFD_E_INVALID, name, "is not valid glTF: %s", problem.what());
    } catch (...) {
        status = ffd_fail_file(error, FFD_E_INVALID, name, "is not valid glTF: tinygltf cannot read it");
    }
    if (status)
        ffd_gltf_free_model(model);
    return status;
}
