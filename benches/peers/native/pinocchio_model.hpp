// A Pinocchio model with the exact frames of the table, without a URDF in between.
#pragma once
#include <pinocchio/multibody.hpp>
#include <string>

#include "flat.hpp"

inline pinocchio::SE3 placement(const double* R, const double* p) {
  Eigen::Matrix3d M;
  M << R[0], R[1], R[2], R[3], R[4], R[5], R[6], R[7], R[8];
  return pinocchio::SE3(M, Eigen::Vector3d(p[0], p[1], p[2]));
}

inline pinocchio::Inertia inertia_of(const FlatBody& body) {
  const double *I = body.inertia, *c = body.com;
  Eigen::Matrix3d inertia;
  inertia << I[0], I[3], I[4], I[3], I[1], I[5], I[4], I[5], I[2];
  return pinocchio::Inertia(body.mass, Eigen::Vector3d(c[0], c[1], c[2]), inertia);
}

inline pinocchio::Model pinocchio_model(const FlatRobot& robot) {
  pinocchio::Model model;
  model.name = robot.name;
  model.gravity.linear() = Eigen::Vector3d(robot.gravity[0], robot.gravity[1], robot.gravity[2]);
  pinocchio::JointIndex root = 0;
  if (robot.floats) {
    root = model.addJoint(0, pinocchio::JointModelFreeFlyer(), pinocchio::SE3::Identity(), "base");
    model.appendBodyToJoint(root, inertia_of(robot.base), pinocchio::SE3::Identity());
  }
  // Of frame 0, then of every joint.
  std::vector<pinocchio::JointIndex> joints{root};
  std::vector<pinocchio::SE3> links{pinocchio::SE3::Identity()};
  for (size_t i = 0; i < robot.joints.size(); i++) {
    const FlatJoint& j = robot.joints[i];
    const pinocchio::JointIndex parent = joints[j.parent + 1];
    const pinocchio::SE3 place = links[j.parent + 1] * placement(j.before_R, j.before_p);
    const std::string name = "j" + std::to_string(i + 1);
    joints.push_back(j.prismatic ? model.addJoint(parent, pinocchio::JointModelPZ(), place, name)
                                 : model.addJoint(parent, pinocchio::JointModelRZ(), place, name));
    links.push_back(placement(j.after_R, j.after_p));
    model.appendBodyToJoint(joints.back(), inertia_of(j), links.back());
  }
  return model;
}
