// A model as the reference knows it.
#pragma once

#include "api/checks.h"
#include "reference/elements.h"

namespace brace::api {

inline reference::LinkCompliance link_of(const brace_plant_link_t &link)
{
    return {link.axial_mm_per_n,   link.bending_mm_per_n,     link.tilt_rad,
            link.lateral_mm_per_n, link.torsion_rad_per_n_mm, link.moment_transfer};
}

inline reference::Lengths lengths_of(const brace_plant_model_t &model)
{
    return {model.geometry.coxa_mm, model.geometry.femur_mm, model.geometry.tibia_mm};
}

inline reference::Limb limb_of(const brace_plant_model_t &model)
{
    reference::Limb limb;
    limb.lengths = lengths_of(model);
    limb.coxa = link_of(model.link[0]);
    limb.femur = link_of(model.link[1]);
    limb.tibia = link_of(model.link[2]);
    limb.coxa_joint_rad_per_n_mm = model.joint[0].compliance_rad_per_n_mm;
    limb.femur_joint_rad_per_n_mm = model.joint[1].compliance_rad_per_n_mm;
    limb.tibia_joint_rad_per_n_mm = model.joint[2].compliance_rad_per_n_mm;
    limb.base_x_mm_per_n = model.base.x_mm_per_n;
    limb.base_z_mm_per_n = model.base.z_mm_per_n;
    limb.base_rotation_rad_per_n_mm = model.base.rotation_rad_per_n_mm;
    return limb;
}

} // namespace brace::api
