# SPDX-License-Identifier: GPL-3.0-or-later
# reachcast_core must be built for the Python inside the Blender that will load it. We ask that Blender; the first
# python3 on the PATH may be another one. Blender reports version, tag and ABI; headers come from the Python of that
# version that has them (a distribution's Blender links the distribution's Python).
find_program(REACHCAST_BLENDER blender DOC "The Blender that will load reachcast_core")
if(NOT REACHCAST_BLENDER)
  message(FATAL_ERROR "Blender was not found: install it (apt-get install blender) or pass -DREACHCAST_BLENDER=/path/to/blender")
endif()
set(probe [[
import sys, sysconfig
print("REACHCAST_PROBE", "%d.%d" % sys.version_info[:2], sysconfig.get_config_var("EXT_SUFFIX"), sys.prefix, sep="|")
]])
execute_process(COMMAND ${REACHCAST_BLENDER} --background --factory-startup --python-expr ${probe}
                OUTPUT_VARIABLE answer ERROR_VARIABLE complaint RESULT_VARIABLE status)
if(NOT answer MATCHES "REACHCAST_PROBE\\|([0-9.]+)\\|([^|]+)\\|([^|\r\n]+)")
  message(FATAL_ERROR "${REACHCAST_BLENDER} did not say which Python it runs (exit ${status}): ${complaint}")
endif()
set(blender_python_version ${CMAKE_MATCH_1})
set(blender_python_suffix ${CMAKE_MATCH_2})
set(blender_python_prefix ${CMAKE_MATCH_3})
find_program(REACHCAST_PYTHON python${blender_python_version} PATHS ${blender_python_prefix}/bin NO_DEFAULT_PATH
             DOC "A Python of Blender's version with headers")
if(NOT REACHCAST_PYTHON)
  message(FATAL_ERROR "Blender runs Python ${blender_python_version}, but ${blender_python_prefix}/bin has no "
                      "python${blender_python_version}: install python3-dev or pass -DREACHCAST_PYTHON=/path/to/python")
endif()
message(STATUS "Blender: ${REACHCAST_BLENDER}, Python ${blender_python_version}, modules end in ${blender_python_suffix}")

set(Python_EXECUTABLE ${REACHCAST_PYTHON})
find_package(Python ${blender_python_version} EXACT REQUIRED COMPONENTS Interpreter Development.Module)
find_package(pybind11 2.10 CONFIG REQUIRED)

file(GLOB binding_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/bindings/*.cpp)
pybind11_add_module(reachcast_core MODULE NO_EXTRAS ${binding_sources})
target_include_directories(reachcast_core PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/bindings)
target_link_libraries(reachcast_core PRIVATE reachcast_predict reachcast_rig)
target_precompile_headers(reachcast_core PRIVATE ${precompiled_headers} <pybind11/numpy.h> <pybind11/pybind11.h> <pybind11/stl.h>)
target_compile_definitions(reachcast_core PRIVATE REACHCAST_VERSION="${PROJECT_VERSION}")
set(REACHCAST_MODULE_DIR ${CMAKE_SOURCE_DIR}/addon/reachcast CACHE PATH "Where the Python module is written")
set_target_properties(reachcast_core PROPERTIES SUFFIX ${blender_python_suffix}
                                                LIBRARY_OUTPUT_DIRECTORY ${REACHCAST_MODULE_DIR})
