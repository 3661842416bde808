#pragma once

#include <filesystem>

#include <gonio/brdf/formats/mbsdf.h>
#include <gonio/brdf/formats/merl.h>
#include <gonio/brdf/table/table.h>

namespace gonio {

/// Any table in the layout of MERL, sampled at the cell centres and corrected by -1/12 of the
/// second differences, so that linear interpolation of the cells keeps the energy; cells with a
/// direction at or below the horizon get -1. A MERL table is taken as it is. Uses all cores.
///
/// With 360 phi_d bins the luminance albedo of measured materials keeps within 0.6 % up to 85
/// degrees (a channel that is nearly black, within 0.001). The common layout with 180 bins is
/// reciprocal by construction: a cell holds the mean of f_r(wi, wo) and f_r(wo, wi), and measured
/// materials, which are not reciprocal, change albedo by up to 20 % near grazing.
/// @throws Error if n_phi_d is neither 180 nor 360.
MerlFile sample_as_merl(const BrdfTable& table, int n_phi_d = 360);

/// Any table on the grid of MBSDF, sampled at the cell centres with wo on the side phi >= 0. Uses
/// all cores. @throws Error if a size is not in 1 to 16384.
MbsdfFile sample_as_mbsdf(const BrdfTable& table, int n_theta, int n_phi);

/// sample_as_merl and write_merl.
void write_table_as_merl(const BrdfTable& table, const std::filesystem::path& path, int n_phi_d = 360);

/// sample_as_mbsdf and write_mbsdf.
void write_table_as_mbsdf(const BrdfTable& table, const std::filesystem::path& path, int n_theta = 90, int n_phi = 180);

}  // namespace gonio
