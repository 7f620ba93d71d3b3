# The fuzz preset does not build the server; this much of it needs no other library and no files.
find_package(OpenMesh CONFIG REQUIRED)
vsplit_fuzzer(mesh_import_fuzzer mesh_import_fuzzer.cpp vsplit_mesh OpenMeshCore)
foreach(
    source
    corner_table edge_table group_table half_edge_mesh image_collector image_header material_library
    mesh_builder om_chunks ply_columns ply_header read_obj read_off read_om read_ply read_stl repair
    repair_join repair_orient repair_split repair_weld text_scan tidy_attributes validate
)
    target_sources(
        mesh_import_fuzzer PRIVATE ${PROJECT_SOURCE_DIR}/server/precompute/${source}.cpp
    )
endforeach()
target_include_directories(mesh_import_fuzzer PRIVATE ${PROJECT_SOURCE_DIR}/server)
