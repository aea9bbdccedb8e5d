/* draco.cpp - decodes Draco data. Only this source and draco_orientations.cpp include Draco. The library
   trusts the numbers in the data's headers and allocates memory for them at once; classes derived from its
   decoders check these numbers first. */
#include "io/gltf/read/draco.h"
#include "base/vector/vec.h"
#include "io/gltf/read/draco_floats.h"
#include "io/gltf/read/draco_orientations.h"
#include "io/gltf/read/gltf_model.h"
#include <cfloat>
#include <cmath>
#include <cstring>
#include <draco/attributes/attribute_octahedron_transform.h>
#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <new>
#include <type_traits>
#include <vector>

struct draco_mesh {
    draco::Mesh mesh;
    std::vector<double> steps; /* by attribute index; 0: not quantized */
};

namespace
{

/* Upper estimates, in bytes, of the memory that the library needs for a triangle, for a triangle in each set
   of attribute seams, for a point, and for each number of an attribute besides the number itself. */
constexpr uint64_t TRIANGLE_MEMORY = 64;
constexpr uint64_t SEAMS_MEMORY = 24;
constexpr uint64_t POINT_MEMORY = 8;
constexpr uint64_t NUMBER_MEMORY = 4;

constexpr int HEADER_SIZE = 11;
constexpr int FLAGS_AT = 9;
constexpr unsigned char METADATA_FLAG = 0x80; /* in the second byte of the flags */

/* A failure of one of our own checks; the library itself only reports that decoding failed. */
struct finding {
    ffd_status status = FFD_OK;
    ffd_error error = {};
};

/* The counts that precede the connectivity. */
struct head {
    uint32_t triangles = 0;
    uint32_t points = 0; /* a lower bound */
    uint8_t seams = 0;   /* sets of attribute seams */
};

bool read_u32(draco::DecoderBuffer &buffer, bool varint, uint32_t &value)
{
    return varint ? draco::DecodeVarint(&value, &buffer) : buffer.Decode(&value);
}

/* Before version 2.0 the numbers were not varints, and before 2.2 another number preceded them (bitstream
   specification, "Edgebreaker connectivity header"). The caller has read the byte before them. */
bool read_head(const draco::MeshEdgebreakerDecoder &, draco::DecoderBuffer buffer, head &found)
{
    const uint16_t version = buffer.bitstream_version();
    const bool varint = version >= DRACO_BITSTREAM_VERSION(2, 0);
    uint32_t unused;
    if (version < DRACO_BITSTREAM_VERSION(2, 2) && !read_u32(buffer, varint, unused))
        return false;
    return read_u32(buffer, varint, found.points) && read_u32(buffer, varint, found.triangles) &&
           buffer.Decode(&found.seams);
}

bool read_head(const draco::MeshSequentialDecoder &, draco::DecoderBuffer buffer, head &found)
{
    const bool varint = buffer.bitstream_version() >= DRACO_BITSTREAM_VERSION(2, 2);
    return read_u32(buffer, varint, found.triangles) && read_u32(buffer, varint, found.points);
}

/* A decoder of the library that checks every count before it is used. */
template <class Decoder> class careful : public Decoder
{
  public:
    careful(const draco_claim &stated, const memory_budget &left) : claim(stated), budget(left) {}

    finding found;

  protected:
    bool InitializeDecoder() override
    {
        head counts;
        if (!Decoder::InitializeDecoder() || !read_head(*this, *this->buffer(), counts))
            return false;
        if (claim.corners != UINT64_MAX && uint64_t(3) * counts.triangles != claim.corners)
            return refuse(
                FFD_E_INVALID, "the Draco data's count of triangles is %lu, that of its indices %llu",
                static_cast<unsigned long>(counts.triangles), static_cast<unsigned long long>(claim.corners));
        if (counts.points > claim.points)
            return refuse_points(counts.points);
        return fits(counts.triangles, TRIANGLE_MEMORY + SEAMS_MEMORY * counts.seams);
    }

    /* The library calls this once the connectivity is decoded. */
    bool CreateAttributesDecoder(int32_t id) override
    {
        return check_points() && Decoder::CreateAttributesDecoder(id);
    }

    bool DecodeAllAttributes() override
    {
        uint64_t point_size = POINT_MEMORY;
        for (int32_t i = 0; i < this->point_cloud()->num_attributes(); i++) {
            const draco::PointAttribute *attribute = this->point_cloud()->attribute(i);
            point_size += POINT_MEMORY + attribute->num_components() *
                                             (NUMBER_MEMORY + draco::DataTypeLength(attribute->data_type()));
        }
        return check_points() && fits(claim.points, point_size) && limit_draco_orientations(*this) &&
               Decoder::DecodeAllAttributes();
    }

  private:
    template <typename... Values> bool refuse(ffd_status status, const char *format, Values... values)
    {
        found.status = ffd_fail(&found.error, status, format, values...);
        return false;
    }

    bool check_points()
    {
        const uint32_t points = this->point_cloud()->num_points();
        return points == claim.points || refuse_points(points);
    }

    bool refuse_points(uint64_t points)
    {
        return refuse(FFD_E_INVALID, "the Draco data's count of points is %llu, that of its accessors %llu",
                      static_cast<unsigned long long>(points), static_cast<unsigned long long>(claim.points));
    }

    bool fits(uint64_t count, uint64_t size)
    {
        found.status = ffd_budget_take(&budget, count, size, &found.error);
        return found.status == FFD_OK;
    }

    const draco_claim claim;
    memory_budget budget;
};

bool skip_name(draco::DecoderBuffer &buffer)
{
    uint8_t size;
    if (!buffer.Decode(&size) || size > buffer.remaining_size())
        return false;
    buffer.Advance(size);
    return true;
}

bool skip_entries(draco::DecoderBuffer &buffer)
{
    uint32_t count, size;
    if (!draco::DecodeVarint(&count, &buffer))
        return false;
    for (uint32_t i = 0; i < count; i++) {
        if (!skip_name(buffer) || !draco::DecodeVarint(&size, &buffer) || size > buffer.remaining_size())
            return false;
        buffer.Advance(size);
    }
    return true;
}

/* Skips a tree of metadata. A node comes after its parent and its earlier siblings, so that counting the
   pending nodes is enough; the root has no name. */
bool skip_tree(draco::DecoderBuffer &buffer)
{
    uint32_t children;
    if (!skip_entries(buffer) || !draco::DecodeVarint(&children, &buffer))
        return false;
    for (uint64_t pending = children; pending > 0; pending += children, pending--)
        if (!skip_name(buffer) || !skip_entries(buffer) || !draco::DecodeVarint(&children, &buffer))
            return false;
    return true;
}

bool skip_metadata(draco::DecoderBuffer &buffer)
{
    uint32_t count, id;
    if (!draco::DecodeVarint(&count, &buffer))
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (!draco::DecodeVarint(&id, &buffer) || !skip_tree(buffer))
            return false;
    return skip_tree(buffer);
}

/* Returns the data without its metadata: glTF does not use it, and the library's reader could fill all memory
   with it. The result is empty if the metadata is broken. */
std::vector<char> without_metadata(const unsigned char *bytes, size_t size, uint16_t version)
{
    draco::DecoderBuffer buffer;
    const char *data = reinterpret_cast<const char *>(bytes);
    buffer.Init(data + HEADER_SIZE, size - HEADER_SIZE, version);
    if (!skip_metadata(buffer))
        return {};
    std::vector<char> kept(data, data + size);
    kept[FLAGS_AT + 1] = static_cast<char>(bytes[FLAGS_AT + 1] & ~METADATA_FLAG);
    kept.erase(kept.begin() + HEADER_SIZE, kept.end() - buffer.remaining_size());
    return kept;
}

/* Returns the quantization step of an attribute plus the rounding of its dequantization, which multiplies and
   adds floats: a few epsilons of the largest one. */
double step_of(draco::PointCloudDecoder &decoder, int32_t attribute)
{
    const draco::PointAttribute *portable = decoder.GetPortableAttribute(attribute);
    const draco::AttributeTransformData *data = portable ? portable->GetAttributeTransformData() : nullptr;
    draco::AttributeQuantizationTransform transform;
    if (!data || data->transform_type() != draco::ATTRIBUTE_QUANTIZATION_TRANSFORM ||
        !transform.InitFromAttribute(*portable))
        return 0;
    /* Not by std::fmax: gcc 12 for arm64 breaks off with an internal error at that loop. */
    double greatest = 0;
    for (const float least : transform.min_values())
        greatest = larger_of(greatest, larger_of(std::fabs(least), std::fabs(least + transform.range())));
    const double step = transform.range() / (std::ldexp(1.0, transform.quantization_bits()) - 1);
    return step >= 0 && std::isfinite(greatest) ? step + 4 * greatest * FLT_EPSILON : 0;
}

/* The integers that an attribute was decoded to, and the floats that the library computed from them. */
struct two_forms {
    const int32_t *integers = nullptr;
    float *floats = nullptr;
    size_t count = 0;
};

/* The count is 0 if either form has fewer elements than the attribute has values. */
two_forms forms_of(const draco::PointAttribute &portable, draco::PointAttribute &attribute)
{
    two_forms forms;
    const size_t count = attribute.size(), integers = portable.num_components(),
                 floats = attribute.num_components();
    if (count == 0 || attribute.data_type() != draco::DT_FLOAT32 || !portable.buffer() ||
        !attribute.buffer() || portable.buffer()->data_size() < count * integers * sizeof(int32_t) ||
        attribute.buffer()->data_size() < count * floats * sizeof(float))
        return forms;
    forms.integers = reinterpret_cast<const int32_t *>(portable.GetAddress(draco::AttributeValueIndex(0)));
    forms.floats = reinterpret_cast<float *>(attribute.GetAddress(draco::AttributeValueIndex(0)));
    forms.count = count;
    return forms;
}

/* Computes the floats of an attribute again with our own code, so that they do not depend on the processor
   that the library was compiled for. */
void make_floats(draco::PointCloudDecoder &decoder, int32_t id, draco::PointAttribute &attribute)
{
    const draco::PointAttribute *portable = decoder.GetPortableAttribute(id);
    if (!portable || !portable->GetAttributeTransformData())
        return;
    const two_forms forms = forms_of(*portable, attribute);
    draco::AttributeQuantizationTransform quantized;
    draco::AttributeOctahedronTransform octahedral;
    if (quantized.InitFromAttribute(*portable) && portable->num_components() == attribute.num_components()) {
        const draco_quantization quantization = {attribute.num_components(), quantized.min_values().data(),
                                                 quantized.range(), quantized.quantization_bits()};
        ffd_draco_dequantize(&quantization, forms.integers, forms.count, forms.floats);
    } else if (octahedral.InitFromAttribute(*portable) && portable->num_components() == 2 &&
               attribute.num_components() == 3) {
        ffd_draco_unfold_normals(octahedral.quantization_bits(), forms.integers, forms.count, forms.floats);
    }
}

template <class Decoder>
ffd_status run(const unsigned char *bytes, size_t size, uint16_t version, const draco_claim &claim,
               const memory_budget &budget, draco_mesh &decoded, ffd_error *error)
{
    std::vector<char> kept;
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char *>(bytes), size);
    if ((bytes[FLAGS_AT + 1] & METADATA_FLAG) && version >= DRACO_BITSTREAM_VERSION(1, 3)) {
        kept = without_metadata(bytes, size, version);
        if (kept.empty())
            return ffd_fail(error, FFD_E_INVALID, "the metadata of the Draco data is broken");
        buffer.Init(kept.data(), kept.size());
    }
    const draco::DecoderOptions options;
    careful<Decoder> decoder(claim, budget);
    const draco::Status status = decoder.Decode(options, &buffer, &decoded.mesh);
    if (decoder.found.status)
        return ffd_fail(error, decoder.found.status, "%s", decoder.found.error.message);
    for (int32_t i = 0; status.ok() && i < decoded.mesh.num_attributes(); i++) {
        make_floats(decoder, i, *decoded.mesh.attribute(i));
        decoded.steps.push_back(step_of(decoder, i));
    }
    if (status.ok())
        return FFD_OK;
    return ffd_fail(error, FFD_E_INVALID, "the Draco data is broken: %s", status.error_msg());
}

ffd_status decode(const unsigned char *bytes, size_t size, const draco_claim &claim,
                  const memory_budget &budget, draco_mesh &decoded, ffd_error *error)
{
    draco::DecoderBuffer buffer;
    draco::DracoHeader header;
    buffer.Init(reinterpret_cast<const char *>(bytes), size);
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok())
        return ffd_fail(error, FFD_E_INVALID, "the compressed data has no Draco header");
    if (header.encoder_type != draco::TRIANGULAR_MESH)
        return ffd_fail(error, FFD_E_UNSUPPORTED,
                        "Draco data of type %d is not supported, only triangle meshes are",
                        header.encoder_type);
    const uint16_t version = DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor);
    const uint16_t newest = DRACO_BITSTREAM_VERSION(draco::kDracoMeshBitstreamVersionMajor,
                                                    draco::kDracoMeshBitstreamVersionMinor);
    if (version > newest || header.version_major < 1)
        return ffd_fail(error, FFD_E_UNSUPPORTED,
                        "Draco bitstream version %d.%d is not known, only up to %d.%d", header.version_major,
                        header.version_minor, draco::kDracoMeshBitstreamVersionMajor,
                        draco::kDracoMeshBitstreamVersionMinor);
    if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING)
        return run<draco::MeshSequentialDecoder>(bytes, size, version, claim, budget, decoded, error);
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
        return run<draco::MeshEdgebreakerDecoder>(bytes, size, version, claim, budget, decoded, error);
    return ffd_fail(error, FFD_E_UNSUPPORTED, "Draco encoding method %d is not known", header.encoder_method);
}

template <typename T> void store(T value, unsigned char *bytes)
{
    using bits_type =
        std::conditional_t<sizeof(T) == 1, uint8_t, std::conditional_t<sizeof(T) == 2, uint16_t, uint32_t>>;
    bits_type bits;
    std::memcpy(&bits, &value, sizeof bits);
    for (size_t i = 0; i < sizeof bits; i++)
        bytes[i] = static_cast<unsigned char>(bits >> (8 * i));
}

bool is_readable(draco::DataType type)
{
    switch (type) {
    case draco::DT_INT8:
    case draco::DT_UINT8:
    case draco::DT_INT16:
    case draco::DT_UINT16:
    case draco::DT_INT32:
    case draco::DT_UINT32:
    case draco::DT_FLOAT32:
        return true;
    default:
        return false;
    }
}

template <typename T>
ffd_status write_attribute(const draco::Mesh &mesh, const draco::PointAttribute &attribute, size_t stride,
                           unsigned char *bytes, ffd_error *error)
{
    const int components = attribute.num_components();
    const uint64_t values =
        attribute.buffer() ? attribute.buffer()->data_size() / static_cast<uint64_t>(attribute.byte_stride())
                           : 0;
    std::vector<T> value(static_cast<size_t>(components));
    for (uint32_t i = 0; i < mesh.num_points(); i++) {
        const draco::AttributeValueIndex at = attribute.mapped_index(draco::PointIndex(i));
        if (at.value() >= values)
            return ffd_fail(error, FFD_E_INVALID, "point %lu of the Draco data has no value in attribute %lu",
                            static_cast<unsigned long>(i), static_cast<unsigned long>(attribute.unique_id()));
        if (!attribute.ConvertValue<T>(at, static_cast<int8_t>(components), value.data()))
            return ffd_fail(error, FFD_E_INVALID,
                            "point %lu of the Draco data has a value in attribute %lu that the accessor's "
                            "component type does not hold",
                            static_cast<unsigned long>(i), static_cast<unsigned long>(attribute.unique_id()));
        for (int c = 0; c < components; c++)
            store(value[static_cast<size_t>(c)], bytes + i * stride + static_cast<size_t>(c) * sizeof(T));
    }
    return FFD_OK;
}

ffd_status read_attribute(const draco::Mesh &mesh, uint32_t id, int component, int components, size_t stride,
                          unsigned char *bytes, ffd_error *error)
{
    const draco::PointAttribute *attribute = mesh.GetAttributeByUniqueId(id);
    if (!attribute)
        return ffd_fail(error, FFD_E_INVALID, "the Draco data has no attribute %lu",
                        static_cast<unsigned long>(id));
    if (attribute->num_components() != components)
        return ffd_fail(error, FFD_E_INVALID,
                        "attribute %lu of the Draco data has %d components, its accessor has %d",
                        static_cast<unsigned long>(id), attribute->num_components(), components);
    if (!is_readable(attribute->data_type()))
        return ffd_fail(error, FFD_E_UNSUPPORTED, "attribute %lu of the Draco data has the unknown type %d",
                        static_cast<unsigned long>(id), attribute->data_type());
    switch (component) {
    case GLTF_I8:
        return write_attribute<int8_t>(mesh, *attribute, stride, bytes, error);
    case GLTF_U8:
        return write_attribute<uint8_t>(mesh, *attribute, stride, bytes, error);
    case GLTF_I16:
        return write_attribute<int16_t>(mesh, *attribute, stride, bytes, error);
    case GLTF_U16:
        return write_attribute<uint16_t>(mesh, *attribute, stride, bytes, error);
    case GLTF_U32:
        return write_attribute<uint32_t>(mesh, *attribute, stride, bytes, error);
    default:
        return write_attribute<float>(mesh, *attribute, stride, bytes, error);
    }
}

} // namespace

extern "C" ffd_status ffd_draco_decode(const unsigned char *bytes, size_t size, const draco_claim *claim,
                                       const memory_budget *budget, draco_mesh **mesh, ffd_error *error)
{
    *mesh = nullptr;
    ffd_status status;
    try {
        std::unique_ptr<draco_mesh> decoded(new draco_mesh);
        status = decode(bytes, size, *claim, *budget, *decoded, error);
        if (status == FFD_OK)
            *mesh = decoded.release();
    } catch (const std::bad_alloc &) {
        status = ffd_fail_memory(error);
    } catch (...) {
        status = ffd_fail(error, FFD_E_INVALID, "the Draco data is broken");
    }
    return status;
}

extern "C" double ffd_draco_step(const draco_mesh *mesh, uint32_t id)
{
    const int32_t attribute = mesh->mesh.GetAttributeIdByUniqueId(id);
    return attribute >= 0 ? mesh->steps[static_cast<size_t>(attribute)] : 0;
}

extern "C" void ffd_draco_free(draco_mesh *mesh)
{
    delete mesh;
}

extern "C" size_t ffd_draco_point_count(const draco_mesh *mesh)
{
    return mesh->mesh.num_points();
}

extern "C" size_t ffd_draco_corner_count(const draco_mesh *mesh)
{
    return 3 * static_cast<size_t>(mesh->mesh.num_faces());
}

extern "C" ffd_status ffd_draco_attribute(const draco_mesh *mesh, uint32_t id, int component, int components,
                                          size_t stride, unsigned char *bytes, ffd_error *error)
{
    try {
        return read_attribute(mesh->mesh, id, component, components, stride, bytes, error);
    } catch (...) {
        return ffd_fail_memory(error);
    }
}

extern "C" ffd_status ffd_draco_indices(const draco_mesh *mesh, int component, unsigned char *bytes,
                                        ffd_error *error)
{
    const uint32_t points = mesh->mesh.num_points();
    const uint32_t most = component == GLTF_U8 ? UINT8_MAX : component == GLTF_U16 ? UINT16_MAX : UINT32_MAX;
    const size_t size = component == GLTF_U8 ? 1 : component == GLTF_U16 ? 2 : 4;
    for (size_t i = 0; i < ffd_draco_corner_count(mesh); i++) {
        const uint32_t corner =
            mesh->mesh.face(draco::FaceIndex(static_cast<uint32_t>(i / 3)))[i % 3].value();
        if (corner >= points || corner > most)
            return ffd_fail(
                error, FFD_E_INVALID,
                "index %zu of the Draco data is %lu: the count of points is %lu, and the component "
                "type holds up to %lu",
                i, static_cast<unsigned long>(corner), static_cast<unsigned long>(points),
                static_cast<unsigned long>(most));
        for (size_t b = 0; b < size; b++)
            bytes[i * size + b] = static_cast<unsigned char>(corner >> (8 * b));
    }
    return FFD_OK;
}
