/* draco_sample.cpp - compresses sample meshes with the Draco library. */
#include "draco_sample.h"
#include <cstdlib>
#include <cstring>
#include <draco/compression/attributes/normal_compression_utils.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

namespace
{

template <typename T>
void add(draco::PointCloud &cloud, draco::GeometryAttribute::Type type, draco::DataType data, int components,
         bool normalized, uint32_t id, const T *values)
{
    if (!values)
        return;
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, static_cast<uint8_t>(components), data, normalized,
                   static_cast<int64_t>(sizeof(T)) * components, 0);
    const int index = cloud.AddAttribute(attribute, true, cloud.num_points());
    for (uint32_t i = 0; i < cloud.num_points(); i++)
        cloud.attribute(index)->SetAttributeValue(draco::AttributeValueIndex(i),
                                                  values + static_cast<size_t>(components) * i);
    cloud.attribute(index)->set_unique_id(id);
}

void fill(draco::PointCloud &cloud, const sample_mesh &mesh)
{
    cloud.set_num_points(static_cast<uint32_t>(mesh.point_count));
    add(cloud, draco::GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, false, SAMPLE_POSITION,
        mesh.positions);
    add(cloud, draco::GeometryAttribute::NORMAL, draco::DT_FLOAT32, 3, false, SAMPLE_NORMAL, mesh.normals);
    add(cloud, draco::GeometryAttribute::TEX_COORD, draco::DT_FLOAT32, 2, false, SAMPLE_TEXCOORD,
        mesh.texcoords);
    add(cloud, draco::GeometryAttribute::GENERIC, draco::DT_UINT16, 4, false, SAMPLE_JOINTS, mesh.joints);
    add(cloud, draco::GeometryAttribute::GENERIC, draco::DT_UINT8, 1, true, SAMPLE_FACTOR, mesh.factors);
    add(cloud, draco::GeometryAttribute::GENERIC, draco::DT_FLOAT32, 4, false, SAMPLE_WEIGHTS, mesh.weights);
    add(cloud, draco::GeometryAttribute::GENERIC, draco::DT_FLOAT32, 4, false, SAMPLE_TANGENT, mesh.tangents);
}

void add_metadata(draco::PointCloud &cloud)
{
    auto metadata = std::make_unique<draco::GeometryMetadata>();
    auto child = std::make_unique<draco::Metadata>();
    child->AddEntryString("name", "a child");
    metadata->AddEntryInt("number", 5);
    metadata->AddSubMetadata("child", std::move(child));
    auto of_attribute = std::make_unique<draco::AttributeMetadata>();
    of_attribute->set_att_unique_id(SAMPLE_POSITION);
    of_attribute->AddEntryString("name", "position");
    metadata->AddAttributeMetadata(std::move(of_attribute));
    cloud.AddMetadata(std::move(metadata));
}

void set_options(draco::ExpertEncoder &encoder, const draco::PointCloud &cloud, const sample_options &options)
{
    for (int i = 0; i < cloud.num_attributes() && options.bits > 0; i++)
        if (cloud.attribute(i)->data_type() == draco::DT_FLOAT32)
            encoder.SetAttributeQuantization(i, options.bits);
    if (!options.as_points)
        encoder.SetEncodingMethod(options.edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                                      : draco::MESH_SEQUENTIAL_ENCODING);
    encoder.SetSpeedOptions(0, 0);
}

unsigned char *copy(const draco::EncoderBuffer &buffer, size_t *size)
{
    *size = buffer.size();
    auto *bytes = static_cast<unsigned char *>(std::malloc(buffer.size()));
    if (bytes)
        std::memcpy(bytes, buffer.data(), buffer.size());
    return bytes;
}

} // namespace

extern "C" unsigned char *make_draco(const sample_mesh *from, const sample_options *options, size_t *size)
{
    draco::Mesh mesh;
    fill(mesh, *from);
    for (size_t i = 0; i < from->triangle_count; i++) {
        draco::Mesh::Face face;
        for (size_t c = 0; c < 3; c++)
            face[c] = from->triangles[3 * i + c];
        mesh.AddFace(face);
    }
    if (options->metadata)
        add_metadata(mesh);
    draco::EncoderBuffer buffer;
    if (options->as_points) {
        draco::ExpertEncoder encoder(static_cast<draco::PointCloud &>(mesh));
        set_options(encoder, mesh, *options);
        return encoder.EncodeToBuffer(&buffer).ok() ? copy(buffer, size) : nullptr;
    }
    draco::ExpertEncoder encoder(mesh);
    set_options(encoder, mesh, *options);
    return encoder.EncodeToBuffer(&buffer).ok() ? copy(buffer, size) : nullptr;
}

extern "C" void unfold_as_draco(int bits, const int32_t place[2], float normal[3])
{
    draco::OctahedronToolBox box;
    box.SetQuantizationBits(bits);
    box.QuantizedOctahedralCoordsToUnitVector(place[0], place[1], normal);
}
