# Embeds text files into the program. Run as a script (by the command below), it writes one of them as
# a C++ raw string literal.
if(CMAKE_SCRIPT_MODE_FILE)
  file(READ "${INPUT}" text)
  if(text MATCHES "\\)embed\"")
    message(FATAL_ERROR "${INPUT}: contains )embed\", which ends the literal that it is embedded in")
  endif()
  file(WRITE "${OUTPUT}" "R\"embed(${text})embed\"")
  return()
endif()
include_guard(GLOBAL)

set(FRESCO_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

# fresco_embed_texts(target file...): each file of this folder becomes a string literal, to be used as
#   constexpr std::string_view kText =
#   #include "<folder>/<file>.inc"
#   ;
function(fresco_embed_texts target)
  foreach(source IN LISTS ARGN)
    set(input ${CMAKE_CURRENT_SOURCE_DIR}/${source})
    cmake_path(RELATIVE_PATH input BASE_DIRECTORY ${CMAKE_SOURCE_DIR} OUTPUT_VARIABLE relative)
    set(output ${CMAKE_BINARY_DIR}/embedded/${relative}.inc)
    add_custom_command(OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} -D INPUT=${input} -D OUTPUT=${output} -P ${FRESCO_EMBED_SCRIPT}
      DEPENDS ${input} ${FRESCO_EMBED_SCRIPT}
      COMMENT "embed ${relative}" VERBATIM)
    target_sources(${target} PRIVATE ${output})
  endforeach()
  target_include_directories(${target} PRIVATE ${CMAKE_BINARY_DIR}/embedded)
endfunction()
