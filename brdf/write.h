#pragma once

#include <gonio/brdf/grid.h>
#include <gonio/brdf/merl.h>
#include <gonio/brdf/table.h>

#include <filesystem>

namespace gonio {

/// Any table in the layout of MERL, sampled at the cell centres; cells with a direction at or below
/// the horizon get -1. With n_phi_d = 180 the layout is reciprocal: a cell holds the mean of
/// f_r(wi, wo) and f_r(wo, wi). With 360 nothing is averaged. Uses all cores.
/// @throws Error if n_phi_d is neither 180 nor 360.
MerlFile sample_as_merl(const BrdfTable& table, int n_phi_d = 180);

/// Any table on the grid of MBSDF, sampled at the cell centres with wo on the side phi >= 0. Uses
/// all cores. @throws Error if a size is not in 1 to 16384.
GridFile sample_as_grid(const BrdfTable& table, int n_theta, int n_phi);

/// sample_as_merl and write_merl.
void write_table_as_merl(const BrdfTable& table, const std::filesystem::path& path,
                         int n_phi_d = 180);

/// sample_as_grid and write_mbsdf.
void write_table_as_mbsdf(const BrdfTable& table, const std::filesystem::path& path,
                          int n_theta = 90, int n_phi = 180);

}  // namespace gonio
