foreach(name gltf_import_fuzzer surface_import_fuzzer)
    vsplit_fuzzer(${name} ${name}.cpp vsplit_mesh_import)
endforeach()
