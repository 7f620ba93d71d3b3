// tinygltf is one header; this is its code, without image decoders and without any access to files. The
// settings are in CMakeLists.txt, as they change the header, too.
#include <fstream>  // which the header forgets then

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
