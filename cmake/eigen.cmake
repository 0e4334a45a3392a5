# Eigen 3.3 or later, Eigen 5 too. It is asked for without a version: the version file of Eigen 5 refuses a request for 3.3.
# A target of the host project counts as it is.
if(NOT TARGET Eigen3::Eigen)
  find_package(Eigen3 REQUIRED NO_MODULE)
  if(Eigen3_VERSION VERSION_LESS 3.3)
    message(FATAL_ERROR "textplane needs Eigen 3.3 or later; ${Eigen3_DIR} is ${Eigen3_VERSION}")
  endif()
endif()
