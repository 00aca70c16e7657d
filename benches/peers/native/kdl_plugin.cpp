// Orocos KDL: recursive Newton-Euler.
#include <kdl/chain.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/tree.hpp>
#include <kdl/treeidsolver_recursive_newton_euler.hpp>

#include "flat.hpp"
#include "rnepeer.h"

namespace {

struct Context {
  int joints;
  KDL::Chain chain;
  KDL::ChainIdSolver_RNE* solver;
  KDL::JntArray q, qd, qdd, tau;
  KDL::Wrenches wrenches;
  KDL::Tree tree;  // of robots with branches, in place of the chain
  KDL::TreeIdSolver_RNE* tree_solver = nullptr;
};

KDL::Frame frame(const double* R, const double* p) {
  return KDL::Frame(KDL::Rotation(R[0], R[1], R[2], R[3], R[4], R[5], R[6], R[7], R[8]), KDL::Vector(p[0], p[1], p[2]));
}

void rne(void* context, const double* q, const double* qd, const double* qdd, double* out) {
  Context& c = *static_cast<Context*>(context);
  for (int i = 0; i < c.joints; i++) {
    c.q.data.data()[i] = q[i];
    c.qd.data.data()[i] = qd[i];
    c.qdd.data.data()[i] = qdd[i];
  }
  if (c.tree_solver)
    c.tree_solver->CartToJnt(c.q, c.qd, c.qdd, {}, c.tau);
  else
    c.solver->CartToJnt(c.q, c.qd, c.qdd, c.wrenches, c.tau);
  for (int i = 0; i < c.joints; i++) out[i] = c.tau.data.data()[i];
}

KDL::RigidBodyInertia inertia_of(const FlatJoint& j) {
  const double* I = j.inertia;
  return KDL::RigidBodyInertia(j.mass, KDL::Vector(j.com[0], j.com[1], j.com[2]),
                               KDL::RotationalInertia(I[0], I[1], I[2], I[3], I[4], I[5]));
}

void build_tree(Context& c, const FlatRobot& robot) {
  const auto name = [](int joint) { return joint < 0 ? std::string("root") : "j" + std::to_string(joint); };
  for (int i = 0; i < c.joints; i++) {
    const FlatJoint& j = robot.joints[i];
    const KDL::Frame before = frame(j.before_R, j.before_p);
    const KDL::Joint joint(name(i), before.p, before.M.UnitZ(),
                           j.prismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis);
    const KDL::Frame link = before * frame(j.after_R, j.after_p);
    c.tree.addSegment(KDL::Segment(name(i), joint, link, inertia_of(j)), name(j.parent));
  }
  c.tree_solver = new KDL::TreeIdSolver_RNE(c.tree, KDL::Vector(robot.gravity[0], robot.gravity[1], robot.gravity[2]));
}

}  // namespace

extern "C" {
int rp_count(void) { return 1; }
const char* rp_name(int) { return "kdl_rne"; }
int rp_kind(int) { return RP_ID; }
void* rp_func(int, const char*) { return reinterpret_cast<void*>(rne); }
void* rp_open(int, const char* robot, const char* dir) {
  const FlatRobot r = read_flat(dir, robot);
  Context* c = new Context;
  c->joints = int(r.joints.size());
  c->q.resize(c->joints), c->qd.resize(c->joints), c->qdd.resize(c->joints), c->tau.resize(c->joints);
  if (r.branches()) return build_tree(*c, r), c;
  // The base's placement only turns gravity; every later one becomes part of the tip of the segment before.
  const KDL::Vector gravity = frame(r.joints[0].before_R, r.joints[0].before_p).M.Inverse() *
                              KDL::Vector(r.gravity[0], r.gravity[1], r.gravity[2]);
  for (int i = 0; i < c->joints; i++) {
    const FlatJoint& j = r.joints[i];
    const bool last = i + 1 == c->joints;
    const KDL::Frame next = last ? KDL::Frame::Identity() : frame(r.joints[i + 1].before_R, r.joints[i + 1].before_p);
    const KDL::Joint joint(j.prismatic ? KDL::Joint::TransZ : KDL::Joint::RotZ);
    c->chain.addSegment(KDL::Segment(joint, frame(j.after_R, j.after_p) * next, next.Inverse() * inertia_of(j)));
  }
  c->wrenches.assign(c->joints, KDL::Wrench::Zero());
  c->solver = new KDL::ChainIdSolver_RNE(c->chain, gravity);
  return c;
}
}
