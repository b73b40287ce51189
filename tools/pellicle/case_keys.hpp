// The keys of a case file, each declared once: name, unit, range, default, what it means.
#pragma once

#include "core/keys.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

/// Visits every key of a case file, in the order in which the resolved file and the docs show them. After reading,
/// defaults that follow from other keys are still to be filled in (see fill_in_defaults).
void describe_case(core::Keys& keys, CaseSpec& spec);

// Its parts, one a file.
void describe_materials_and_walls(core::Keys& keys, CaseSpec& spec);
void describe_walls(core::Keys& keys, CaseSpec& spec);
void describe_contacts(core::Keys& keys, CaseSpec& spec);
void describe_particles(core::Keys& keys, CaseSpec& spec);
void describe_gas(core::Keys& keys, CaseSpec& spec);
void describe_coupling(core::Keys& keys, CaseSpec& spec);
/// Of the particles, and their films.
void describe_heat_and_films(core::Keys& keys, CaseSpec& spec);
void describe_spray(core::Keys& keys, CaseSpec& spec);
void describe_output(core::Keys& keys, CaseSpec& spec);

// Pieces that several parts use.

/// Two opposite corners, with `max` beyond `min` in every direction.
void describe_box(core::Keys& keys, Box& box);
/// The same, but `max` may also be level with `min`: a part of a side.
void describe_flat_box(core::Keys& keys, Box& box);
/// Round shapes: the ends of the axis, which are different points, and the radii.
void describe_cylinder(core::Keys& keys, dem::CylinderRegion& cylinder);
void describe_cone(core::Keys& keys, dem::ConeRegion& cone);
/// Numbers of cells, faces, or sizes with zones; these become cells when all has been read, see fill_in_defaults.
void describe_gas_grid(core::Keys& keys, GridSpec& grid, const DomainSpec& domain);
void describe_transfer_grid(core::Keys& keys, GridSpec& transfer, const DomainSpec& domain);
/// The quantities that a probe of this kind may show.
core::ModelList quantities_of(const ProbeSpec& probe);
/// How diameters are spread, of particles or of droplets.
void describe_sizes(core::Keys& keys, SizesSpec& sizes);
/// The radii of a disc that may have a hole.
void describe_ring(core::Keys& keys, Real& radius, Real& inner_radius);
/// A number for which 0 stands for "not given".
void real_or_unset(core::Keys& keys, const core::Key& key, const core::RealRule& rule, Real& value);
/// The name of a material for its index; one that is not known becomes a rigid one or is refused.
void material_key(core::Keys& keys, const core::Key& key, CaseSpec& spec, int& material, bool may_be_new);
/// Index of a material, or -1.
int find_material(const CaseSpec& spec, std::string_view name);
/// Names of the materials, `a, b`; of those with properties only, or of all.
std::string material_names(const CaseSpec& spec, bool with_rigid);

}  // namespace pellicle::tools
