# penumbra_embed(TARGET SYMBOL FILES...) compiles text files into TARGET as
#   std::span<const penumbra::EmbeddedFile> SYMBOL();
# SYMBOL is a qualified function name. Files are named by their path from the repository's root,
# so that one name serves includes, error messages and documentation.
function(penumbra_embed target symbol)
  string(REPLACE "::" "_" stem ${symbol})
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${stem}.cpp)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DSYMBOL=${symbol} -DROOT=${PROJECT_SOURCE_DIR}
            "-DFILES=${ARGN}" -P ${PROJECT_SOURCE_DIR}/cmake/write_embedded.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/write_embedded.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
