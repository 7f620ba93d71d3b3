# Draco's mesh decoder, compiled from the sources in build/wasm-root (scripts/build-wasm), for a target for
# which no one packages Draco.
set(draco_sources ${CMAKE_CURRENT_LIST_DIR}/../../build/wasm-root/src/draco)
add_library(
    draco_static STATIC
    ${draco_sources}/attributes/attribute_transform.cc
    ${draco_sources}/attributes/attribute_octahedron_transform.cc
    ${draco_sources}/attributes/attribute_quantization_transform.cc
    ${draco_sources}/attributes/geometry_attribute.cc
    ${draco_sources}/attributes/point_attribute.cc
    ${draco_sources}/compression/attributes/attributes_decoder.cc
    ${draco_sources}/compression/attributes/sequential_attribute_decoder.cc
    ${draco_sources}/compression/attributes/sequential_attribute_decoders_controller.cc
    ${draco_sources}/compression/attributes/sequential_integer_attribute_decoder.cc
    ${draco_sources}/compression/attributes/sequential_normal_attribute_decoder.cc
    ${draco_sources}/compression/attributes/sequential_quantization_attribute_decoder.cc
    ${draco_sources}/compression/bit_coders/rans_bit_decoder.cc
    ${draco_sources}/compression/entropy/symbol_decoding.cc
    ${draco_sources}/compression/mesh/mesh_decoder.cc
    ${draco_sources}/compression/mesh/mesh_edgebreaker_decoder.cc
    ${draco_sources}/compression/mesh/mesh_edgebreaker_decoder_impl.cc
    ${draco_sources}/compression/mesh/mesh_sequential_decoder.cc
    ${draco_sources}/compression/point_cloud/point_cloud_decoder.cc
    ${draco_sources}/core/bit_utils.cc
    ${draco_sources}/core/bounding_box.cc
    ${draco_sources}/core/data_buffer.cc
    ${draco_sources}/core/decoder_buffer.cc
    ${draco_sources}/core/divide.cc
    ${draco_sources}/core/draco_types.cc
    ${draco_sources}/core/options.cc
    ${draco_sources}/core/quantization_utils.cc
    ${draco_sources}/mesh/corner_table.cc
    ${draco_sources}/mesh/mesh.cc
    ${draco_sources}/mesh/mesh_attribute_corner_table.cc
    ${draco_sources}/metadata/geometry_metadata.cc
    ${draco_sources}/metadata/metadata.cc
    ${draco_sources}/metadata/metadata_decoder.cc
    ${draco_sources}/point_cloud/point_cloud.cc
)
target_include_directories(draco_static SYSTEM PUBLIC ${draco_sources}/..)
target_compile_options(draco_static PRIVATE -w -ffp-contract=off)
add_library(draco::draco_static ALIAS draco_static)
