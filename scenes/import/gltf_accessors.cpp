#include <cmath>
#include <cstring>
#include <limits>

#include "renderer/error.h"
#include "scenes/import/gltf.h"

namespace penumbra::scenes::gltf {
namespace {

/// Elements of an accessor that no buffer backs: zeros cost a file nothing, memory they do.
constexpr std::size_t max_unbacked = 1u << 24;

std::size_t component_size(int type, const std::string& where) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      throw unreadable(where + " has no component type of glTF: " + std::to_string(type), where);
  }
}

/// Bytes of `count` elements in a buffer view, all of them checked to be there.
struct Elements {
  const unsigned char* data = nullptr;
  std::size_t stride = 0;
};

Elements elements_of(const tinygltf::Model& model, int view_index, std::size_t offset,
                     std::size_t count, std::size_t element_size, bool packed,
                     const std::string& where) {
  if (view_index < 0 || static_cast<std::size_t>(view_index) >= model.bufferViews.size())
    throw unreadable(where + " names no buffer view", where);
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(view_index)];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
    throw unreadable(where + ": its buffer view names no buffer", where);
  const auto& bytes = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
    throw unreadable(where + ": its buffer view reaches beyond the buffer", where);
  Elements elements;
  elements.stride = packed || view.byteStride == 0 ? element_size : view.byteStride;
  if (elements.stride < element_size || elements.stride > 252 + element_size)
    throw unreadable(where + ": its stride is not in 4..252 or less than an element", where);
  if (count > 0 && (offset > view.byteLength || element_size > view.byteLength - offset ||
                    count - 1 > (view.byteLength - offset - element_size) / elements.stride))
    throw unreadable(where + " reaches beyond its buffer view", where);
  elements.data = bytes.data() + view.byteOffset + offset;
  return elements;
}

template <class T>
T load(const unsigned char* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// One component as a number; integers that mean fractions by glTF 2.0, 3.6.2.2.
float component(const unsigned char* at, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const float value = load<std::int8_t>(at);
      return normalized ? std::max(value / 127.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
      const float value = load<std::uint8_t>(at);
      return normalized ? value / 255.0f : value;
    }
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const float value = load<std::int16_t>(at);
      return normalized ? std::max(value / 32767.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const float value = load<std::uint16_t>(at);
      return normalized ? value / 65535.0f : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: {
      const auto value = static_cast<double>(load<std::uint32_t>(at));
      return static_cast<float>(normalized ? value / 4294967295.0 : value);
    }
    default:
      return load<float>(at);
  }
}

std::uint32_t index_at(const unsigned char* at, int type, const std::string& where) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<std::uint32_t>(at);
    default:
      throw unreadable(where + " must hold unsigned integers", where);
  }
}

const tinygltf::Accessor& accessor_of(const tinygltf::Model& model, int index,
                                      const std::string& where) {
  if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size())
    throw unreadable(where + " names no accessor", where);
  return model.accessors[static_cast<std::size_t>(index)];
}

/// Visits the replaced elements of a sparse accessor: (index, bytes of the value).
template <class Visit>
void visit_sparse(const tinygltf::Model& model, const tinygltf::Accessor& accessor,
                  std::size_t element_size, const std::string& where, const Visit& visit) {
  if (!accessor.sparse.isSparse) return;
  const auto& sparse = accessor.sparse;
  if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > accessor.count)
    throw unreadable(where + ".sparse has more elements than the accessor", where);
  const auto count = static_cast<std::size_t>(sparse.count);
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
    throw unreadable(where + ".sparse has a negative offset", where);
  const std::size_t index_size = component_size(sparse.indices.componentType, where);
  const Elements indices = elements_of(model, sparse.indices.bufferView,
                                       static_cast<std::size_t>(sparse.indices.byteOffset), count,
                                       index_size, true, where + ".sparse.indices");
  const Elements values = elements_of(model, sparse.values.bufferView,
                                      static_cast<std::size_t>(sparse.values.byteOffset), count,
                                      element_size, true, where + ".sparse.values");
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = index_at(indices.data + i * indices.stride,
                                         sparse.indices.componentType, where + ".sparse.indices");
    if (index >= accessor.count)
      throw unreadable(where + ".sparse.indices has an index beyond the accessor", where);
    visit(index, values.data + i * values.stride);
  }
}

std::size_t checked_count(const tinygltf::Accessor& accessor, const std::string& where) {
  if (accessor.bufferView < 0 && accessor.count > max_unbacked)
    throw unreadable(where + " has too many elements without a buffer view", where);
  return accessor.count;
}

}  // namespace

int components_of(const tinygltf::Model& model, int index, const std::string& where) {
  const int components = tinygltf::GetNumComponentsInType(
      static_cast<std::uint32_t>(accessor_of(model, index, where).type));
  if (components < 1) throw unreadable(where + " has no type of glTF", where);
  return components;
}

std::vector<float> read_floats(const tinygltf::Model& model, int index, int components,
                               const std::string& where) {
  const tinygltf::Accessor& accessor = accessor_of(model, index, where);
  if (components_of(model, index, where) != components)
    throw unreadable(where + " must have " + std::to_string(components) + " components", where);
  const auto width = static_cast<std::size_t>(components);
  const std::size_t size = component_size(accessor.componentType, where);
  const std::size_t count = checked_count(accessor, where);
  std::vector<float> values;
  const auto convert = [&](const unsigned char* from, float* to) {
    for (std::size_t c = 0; c < width; ++c)
      to[c] = component(from + c * size, accessor.componentType, accessor.normalized);
  };
  if (accessor.bufferView >= 0) {
    const Elements elements = elements_of(model, accessor.bufferView, accessor.byteOffset, count,
                                          width * size, false, where);
    values.resize(count * width);
    for (std::size_t i = 0; i < count; ++i)
      convert(elements.data + i * elements.stride, &values[i * width]);
  } else {
    values.assign(count * width, 0.0f);
  }
  visit_sparse(
      model, accessor, width * size, where,
      [&](std::uint32_t i, const unsigned char* from) { convert(from, &values[i * width]); });
  return values;
}

std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int index,
                                        const std::string& where) {
  const tinygltf::Accessor& accessor = accessor_of(model, index, where);
  if (components_of(model, index, where) != 1)
    throw unreadable(where + " must have one component", where);
  const std::size_t size = component_size(accessor.componentType, where);
  const std::size_t count = checked_count(accessor, where);
  std::vector<std::uint32_t> indices;
  if (accessor.bufferView >= 0) {
    const Elements elements =
        elements_of(model, accessor.bufferView, accessor.byteOffset, count, size, false, where);
    indices.resize(count);
    for (std::size_t i = 0; i < count; ++i)
      indices[i] = index_at(elements.data + i * elements.stride, accessor.componentType, where);
  } else {
    indices.assign(count, 0);
  }
  visit_sparse(model, accessor, size, where, [&](std::uint32_t i, const unsigned char* from) {
    indices[i] = index_at(from, accessor.componentType, where);
  });
  return indices;
}

}  // namespace penumbra::scenes::gltf
