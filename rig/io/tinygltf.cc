// SPDX-License-Identifier: MIT
#define TINYGLTF_IMPLEMENTATION
#include "rig/io/tinygltf.h"
