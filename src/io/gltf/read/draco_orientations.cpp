#include "io/gltf/read/draco_orientations.h"
#include <cstring>
#include <draco/compression/attributes/sequential_attribute_decoders_controller.h>
#include <draco/compression/attributes/sequential_integer_attribute_decoder.h>
#include <draco/compression/attributes/sequential_quantization_attribute_decoder.h>
#include <draco/core/varint_decoding.h>
#include <type_traits>
#include <typeinfo>

using decoder_list = std::vector<std::unique_ptr<draco::SequentialAttributeDecoder>>;
using controller = draco::SequentialAttributeDecodersController;

/* The controller creates its decoders itself and offers no access to them. An explicit instantiation may name
   a private member (C++17, 17.7.2), which gives access to the list. */
decoder_list &decoders_of(controller &owner);
template <decoder_list controller::*member> struct opened_member {
    friend decoder_list &decoders_of(controller &owner) { return owner.*member; }
};
template struct opened_member<&controller::sequential_decoders_>;

namespace
{

using scheme_interface = draco::PredictionSchemeTypedDecoderInterface<int32_t>;

bool read_count(draco::DecoderBuffer buffer, draco::PredictionSchemeMethod method, uint32_t &count)
{
    const bool varint = method == draco::MESH_PREDICTION_TEX_COORDS_DEPRECATED &&
                        buffer.bitstream_version() >= DRACO_BITSTREAM_VERSION(2, 2);
    return varint ? draco::DecodeVarint(&count, &buffer) : buffer.Decode(&count);
}

/* A prediction scheme that checks the number of orientations first. */
class limited_scheme : public scheme_interface
{
  public:
    limited_scheme(std::unique_ptr<scheme_interface> limited, uint32_t largest)
        : scheme(std::move(limited)), most(largest)
    {
    }

    bool DecodePredictionData(draco::DecoderBuffer *buffer) override
    {
        uint32_t count;
        return read_count(*buffer, scheme->GetPredictionMethod(), count) && count <= most &&
               scheme->DecodePredictionData(buffer);
    }

    bool ComputeOriginalValues(const int32_t *corrections, int32_t *values, int size, int components,
                               const draco::PointIndex *points) override
    {
        return scheme->ComputeOriginalValues(corrections, values, size, components, points);
    }

    draco::PredictionSchemeMethod GetPredictionMethod() const override
    {
        return scheme->GetPredictionMethod();
    }

    const draco::PointAttribute *GetAttribute() const override { return scheme->GetAttribute(); }

    bool IsInitialized() const override { return scheme->IsInitialized(); }

    int GetNumParentAttributes() const override { return scheme->GetNumParentAttributes(); }

    draco::GeometryAttribute::Type GetParentAttributeType(int i) const override
    {
        return scheme->GetParentAttributeType(i);
    }

    bool SetParentAttribute(const draco::PointAttribute *attribute) override
    {
        return scheme->SetParentAttribute(attribute);
    }

    bool AreCorrectionsPositive() override { return scheme->AreCorrectionsPositive(); }

    draco::PredictionSchemeTransformType GetTransformType() const override
    {
        return scheme->GetTransformType();
    }

  private:
    const std::unique_ptr<scheme_interface> scheme;
    const uint32_t most;
};

template <class Decoder> class limited_decoder : public Decoder
{
  public:
    explicit limited_decoder(uint32_t largest) : most(largest) {}

  protected:
    std::unique_ptr<scheme_interface>
    CreateIntPredictionScheme(draco::PredictionSchemeMethod method,
                              draco::PredictionSchemeTransformType transform) override
    {
        /* The library does not check the method's byte of the file: an unknown method makes no scheme. */
        std::underlying_type_t<draco::PredictionSchemeMethod> number;
        static_assert(sizeof number == sizeof method, "an enumeration has the size of its type");
        std::memcpy(&number, &method, sizeof number);
        if (static_cast<int>(number) < draco::PREDICTION_NONE ||
            static_cast<int>(number) >= draco::NUM_PREDICTION_SCHEMES)
            return nullptr;
        auto scheme = Decoder::CreateIntPredictionScheme(method, transform);
        if (!scheme || (scheme->GetPredictionMethod() != draco::MESH_PREDICTION_TEX_COORDS_PORTABLE &&
                        scheme->GetPredictionMethod() != draco::MESH_PREDICTION_TEX_COORDS_DEPRECATED))
            return scheme;
        return std::unique_ptr<scheme_interface>(new limited_scheme(std::move(scheme), most));
    }

  private:
    const uint32_t most;
};

/* Replaces a decoder of type Decoder by a limited one. Returns false if that cannot be initialized. */
template <class Decoder>
bool replace(draco::MeshDecoder &mesh, int attribute, uint32_t most,
             std::unique_ptr<draco::SequentialAttributeDecoder> &decoder)
{
    const draco::SequentialAttributeDecoder &old = *decoder;
    if (typeid(old) != typeid(Decoder))
        return true;
    decoder.reset(new limited_decoder<Decoder>(most));
    return decoder->Init(&mesh, attribute);
}

} // namespace

bool limit_draco_orientations(draco::MeshDecoder &mesh)
{
    const uint32_t most = 3 * mesh.mesh()->num_faces();
    for (int i = 0; i < mesh.num_attributes_decoders(); i++) {
        auto *owner = dynamic_cast<controller *>(
            const_cast<draco::AttributesDecoderInterface *>(mesh.attributes_decoder(i)));
        if (!owner)
            continue;
        decoder_list &decoders = decoders_of(*owner);
        for (size_t k = 0; k < decoders.size(); k++) {
            const int attribute = owner->GetAttributeId(static_cast<int>(k));
            if (!replace<draco::SequentialIntegerAttributeDecoder>(mesh, attribute, most, decoders[k]) ||
                !replace<draco::SequentialQuantizationAttributeDecoder>(mesh, attribute, most, decoders[k]))
                return false;
        }
    }
    return true;
}
