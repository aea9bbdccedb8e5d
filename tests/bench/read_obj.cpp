/* Reads an OBJ by another library, and writes what it has read where OUT is given: peers of bench.py.

     read_obj                           the libraries that are there, a line each
     read_obj LIBRARY IN.obj [OUT.obj] */
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <cstdio>
#include <cstring>
#ifdef FFD_TINYOBJ
#include <tiny_obj_loader.h>
#endif

namespace
{

struct library {
    const char *name;
    bool (*run)(const char *in, const char *out); /* out: NULL to read only */
};

bool run_openmesh(const char *in, const char *out)
{
    OpenMesh::PolyMesh_ArrayKernelT<> mesh;
    mesh.request_vertex_normals();
    mesh.request_vertex_texcoords2D();
    OpenMesh::IO::Options wanted = OpenMesh::IO::Options::VertexNormal, found;
    wanted += OpenMesh::IO::Options::VertexTexCoord;
    found = wanted; /* the reader changes it to what the file has */
    return OpenMesh::IO::read_mesh(mesh, in, found) && (!out || OpenMesh::IO::write_mesh(mesh, out, wanted));
}

#ifdef FFD_TINYOBJ
/* It has no writer. */
bool run_tinyobj(const char *in, const char *out)
{
    tinyobj::ObjReader reader;
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    return !out && reader.ParseFromFile(in, config);
}
#endif

const library libraries[] = {
#ifdef FFD_TINYOBJ
    {"tinyobjloader", run_tinyobj},
#endif
    {"OpenMesh", run_openmesh},
};

} // namespace

int main(int count, char **arguments)
{
    for (const library &one : libraries) {
        if (count == 1)
            std::puts(one.name);
        else if (count > 2 && std::strcmp(arguments[1], one.name) == 0)
            return one.run(arguments[2], count > 3 ? arguments[3] : nullptr) ? 0 : 1;
    }
    return count == 1 ? 0 : 2;
}
