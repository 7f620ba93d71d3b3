# The fuzz preset does not build the server; this much of it reads and writes models without files.
find_package(draco CONFIG REQUIRED)
find_package(nlohmann_json REQUIRED)
set(
    import_sources
    corner_table edge_table glb_materials gltf_accessor gltf_document gltf_draco gltf_materials gltf_nodes
    gltf_primitive group_table half_edge_mesh image_collector image_header material_library mesh_builder
    model_writers ply_columns ply_header read_gltf read_obj read_ply repair repair_join repair_orient repair_split
    repair_surface repair_weld text_scan tidy_attributes tiny_gltf validate wedge_mesh write_glb write_obj
    write_ply
)
foreach(name gltf_import_fuzzer surface_import_fuzzer)
    vsplit_fuzzer(
        ${name} ${name}.cpp vsplit_mesh OpenMeshCore draco::draco_static
        nlohmann_json::nlohmann_json
    )
    foreach(source ${import_sources})
        target_sources(${name} PRIVATE ${PROJECT_SOURCE_DIR}/server/precompute/${source}.cpp)
    endforeach()
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/server)
    target_compile_definitions(
        ${name} PRIVATE TINYGLTF_NO_FS TINYGLTF_NO_STB_IMAGE TINYGLTF_NO_STB_IMAGE_WRITE
    )
endforeach()
