// SPDX-License-Identifier: MIT
#pragma once

// tinygltf without pictures; tinygltf.cc holds its implementation.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
