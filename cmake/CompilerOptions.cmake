# Compiler caching, sanitizers and the one function that sets warnings.

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

if(ARTICAP_SANITIZE)
  # Under AddressSanitizer Eigen aligns memory by hand, but templates that libceres.so instantiates too
  # may come from there, where malloc is trusted: what one allocates the other could not free.
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1)
  # Without the checks that AddressSanitizer makes superfluous and that double the time to compile.
  add_compile_options(-fsanitize=address,undefined -fno-sanitize=null,object-size,vptr
                      -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()

# Fuzzers need every object instrumented for coverage, not only the target's own.
if(ARTICAP_BUILD_FUZZERS)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# Warnings of articap's own targets; other people's headers are included as SYSTEM.
function(articap_target_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                         -Wno-sign-conversion -Wno-missing-field-initializers -Wnon-virtual-dtor -Woverloaded-virtual)
  # GCC 12 reports std::string's operator+ as overlapping memory (GCC bug 105651).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  if(ARTICAP_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# One library target a folder: articap_<folder>, exported as articap::<folder>.
function(articap_add_library folder)
  add_library(articap_${folder} ${ARGN})
  add_library(articap::${folder} ALIAS articap_${folder})
  set_target_properties(articap_${folder} PROPERTIES EXPORT_NAME ${folder})
  target_include_directories(articap_${folder} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/articap>)
  articap_target_warnings(articap_${folder})
endfunction()
