// SPDX-License-Identifier: Apache-2.0
#include "world_file/elements/format.h"

namespace kiva {

/// Elements of SDF 1.9, one a line that begins with #. A line has the name; how often the element
/// may occur (! once, ? at most once, + once or more, * any number, x no longer); its text as
/// `:type=default<least>most`; attributes behind @, with ! if they are required; ~ if it may hold
/// anything; and in parentheses its children, where &other is the element of that line, ^other the
/// enclosing one of that name. Types: b bool, c colour, d double, i and u integers, p pose, s
/// string, t time, 2 and 3 vectors.
const char* const kFormatText = R"(
#pose pose?:p='0 0 0 0 0 0' @relative_to?s='' @rotation_format?s=euler_rpy @degrees?b=false
#plugin plugin* @name!s=__default__ @filename!s=__default__ ~
#atmosphere atmosphere! @type!s=adiabatic (temperature?:d=288.15 pressure?:d=101325
temperature_gradient?:d=-0.0065)
#gui gui? @fullscreen?b=false (&plugin* camera? @name!s=user_camera (view_controller?:s=orbit
projection_type?:s=perspective track_visual? (name?:s=__default__ min_dist?:d=0 max_dist?:d=0
static?:b=false use_model_frame?:b=true xyz?:3='-5.0 0.0 3.0' inherit_yaw?:b=false) &pose?))
#physics physics! @name?s=default_physics @default?b=false @type!s=ode (max_step_size!:d=0.001
real_time_factor!:d=1.0 real_time_update_rate!:d=1000 max_contacts?:i=20 dart? (solver!
(solver_type!:s=dantzig) collision_detector?:s=fcl) simbody? (min_step_size?:d=0.0001
accuracy?:d=1e-3 max_transient_velocity?:d=0.01 contact? (stiffness?:d=1e8 dissipation?:d=100
plastic_coef_restitution?:d=0.5 plastic_impact_velocity?:d=0.5 static_friction?:d=0.9
dynamic_friction?:d=0.9 viscous_friction?:d=0.0 override_impact_capture_velocity?:d=0.001
override_stiction_transition_velocity?:d=0.001)) bullet? (solver! (type!:s=sequential_impulse
min_step_size?:d=0.0001 iters!:i=50 sor!:d=1.3) constraints! (cfm!:d=0 erp!:d=0.2
contact_surface_layer!:d=0.001 split_impulse!:b=true
split_impulse_penetration_threshold!:d=-0.01)) ode? (solver! (type!:s=quick
min_step_size?:d=0.0001 island_threads?:i=0 iters!:i=50 precon_iters?:i=0 sor!:d=1.3
thread_position_correction?:b=false use_dynamic_moi_rescaling!:b=false
friction_model?:s=pyramid_model) constraints! (cfm!:d=0 erp!:d=0.2
contact_max_correcting_vel!:d=100.0 contact_surface_layer!:d=0.001)))
#scene scene! (ambient!:c='0.4 0.4 0.4 1.0' background!:c='.7 .7 .7 1' sky? (time?:d=10.0
sunrise?:d=6.0 sunset?:d=20.0 clouds? (speed?:d=0.6<0.0 direction?:d=0.0<0.0>3.1456
humidity?:d=0.5<0>1 mean_size?:d=0.5<0>1 ambient?:c='.8 .8 .8 1')) shadows!:b=true fog?
(color?:c='1 1 1 1' type?:s=none start?:d=1.0<0.0 end?:d=100.0<0.0 density?:d=1.0<0.0)
grid?:b=true origin_visual?:b=true)
#light light* @name!s=__default__ @type!s=point (cast_shadows?:b=false intensity?:d=1 &pose?
diffuse?:c='1 1 1 1' specular?:c='.1 .1 .1 1' attenuation? (range!:d=10 linear?:d=1 constant?:d=1
quadratic?:d=0) direction!:3='0 0 -1' spot? (inner_angle!:d=0 outer_angle!:d=0 falloff!:d=0))
#frame frame* @name!s='' @attached_to?s='' (&pose?)
#inertial inertial? (mass?:d=1.0 pose?:p='0 0 0 0 0 0' @rotation_format?s=euler_rpy
@degrees?b=false inertia? (ixx!:d=1.0 ixy!:d=0.0 ixz!:d=0.0 iyy!:d=1.0 iyz!:d=0.0 izz!:d=1.0))
#box_shape box? (size!:3='1 1 1')
#capsule_shape capsule? (radius!:d=0.5 length!:d=1)
#cylinder_shape cylinder? (radius!:d=1 length!:d=1)
#ellipsoid_shape ellipsoid? (radii!:3='1 1 1')
#heightmap_shape heightmap? (uri!:s=__default__ size?:3='1 1 1' pos?:3='0 0 0' texture*
(size!:d=10 diffuse!:s=__default__ normal!:s=__default__) blend* (min_height!:d=0 fade_dist!:d=0)
use_terrain_paging?:b=false sampling?:u=1)
#image_shape image? (uri!:s=__default__ scale!:d=1 threshold!:i=200 height!:d=1 granularity!:i=1)
#mesh_shape mesh? (uri!:s=__default__ submesh? (name!:s=__default__ center?:b=false) scale?:3='1 1
1')
#plane_shape plane? (normal!:3='0 0 1' size!:2='1 1')
#polyline_shape polyline? (point+:2='0 0' height!:d=1.0)
#sphere_shape sphere? (radius!:d=1)
#geometry geometry! (empty? &box_shape? &capsule_shape? &cylinder_shape? &ellipsoid_shape?
&heightmap_shape? &image_shape? &mesh_shape? &plane_shape? &polyline_shape? &sphere_shape?)
#surface surface? (bounce? (restitution_coefficient?:d=0<0.0>1.0 threshold?:d=100000) friction?
(torsional? (coefficient?:d=1.0<0.0 use_patch_radius?:b=true patch_radius?:d=0<0.0
surface_radius?:d=0.0<0.0 ode? (slip?:d=0.0)) ode? (mu?:d=1<0.0 mu2?:d=1<0.0 fdir1?:3='0 0 0'
slip1?:d=0.0 slip2?:d=0.0) bullet? (friction?:d=1<0.0 friction2?:d=1<0.0 fdir1?:3='0 0 0'
rolling_friction?:d=1)) contact? (collide_without_contact?:b=false
collide_without_contact_bitmask?:u=1 collide_bitmask?:u=65535 category_bitmask?:u=65535
poissons_ratio?:d=0.3 elastic_modulus?:d=-1 ode? (soft_cfm?:d=0 soft_erp?:d=0.2
kp?:d=1000000000000.0 kd?:d=1.0 max_vel?:d=0.01 min_depth?:d=0) bullet? (soft_cfm?:d=0
soft_erp?:d=0.2 kp?:d=1000000000000.0 kd?:d=1.0 split_impulse!:b=true
split_impulse_penetration_threshold!:d=-0.01)) soft_contact? (dart? (bone_attachment!:d=100.0
stiffness!:d=100.0 damping!:d=10.0 flesh_mass_fraction!:d=0.05)))
#collision collision* @name!s=__default__ (laser_retro?:d=0 max_contacts?:i=10 &pose? &geometry!
&surface?)
#material material? (script? (uri+:s=__default__ name!:s=__default__) shader? @type!s=pixel
(normal_map?:s=__default__) render_order?:d=0.0 lighting?:b=true ambient?:c='0 0 0 1'
diffuse?:c='0 0 0 1' specular?:c='0 0 0 1' emissive?:c='0 0 0 1' double_sided?:b=false pbr?
(metal? (albedo_map?:s='' roughness_map?:s='' roughness?:s=0.5 metalness_map?:s=''
metalness?:s=0.5 environment_map?:s='' ambient_occlusion_map?:s='' normal_map?:s=''
@type?s=tangent emissive_map?:s='' light_map?:s='' @uv_set?u=0) specular? (albedo_map?:s=''
specular_map?:s='' glossiness_map?:s='' glossiness?:s=0 environment_map?:s=''
ambient_occlusion_map?:s='' normal_map?:s='' @type?s=tangent emissive_map?:s='' light_map?:s=''
@uv_set?u=0)))
#visual visual* @name!s=__default__ (cast_shadows?:b=true laser_retro?:d=0.0 transparency?:d=0.0
visibility_flags?:u=4294967295 meta? (layer?:i=0) &pose? &material? &geometry! &plugin*)
#noise noise! @type!s=none (mean?:d=0.0 stddev?:d=0.0<0.0 bias_mean?:d=0.0 bias_stddev?:d=0.0<0.0
dynamic_bias_stddev?:d=0.0<0.0 dynamic_bias_correlation_time?:d=0.0 precision?:d=0.0)
#air_pressure air_pressure? (reference_altitude?:d=0.0 pressure? (&noise?))
#altimeter altimeter? (vertical_position? (&noise?) vertical_velocity? (&noise?))
#camera camera? @name?s=__default__ (horizontal_fov!:d=1.047<0.1>6.283186 image! (width!:i=320
height!:i=240 format?:s=R8G8B8) clip! (near!:d=.1<0.0 far!:d=100<0.1) save? @enabled!b=false
(path!:s=__default__) depth_camera? (output!:s=depths clip? (near?:d=.1<0.0 far?:d=10.0<0.1))
segmentation_type?:s=semantic box_type?:s=2d noise? (type!:s=gaussian mean?:d=0.0 stddev?:d=0.0)
distortion? (k1?:d=0.0 k2?:d=0.0 k3?:d=0.0 p1?:d=0.0 p2?:d=0.0 center?:2='0.5 0.5') lens?
(type!:s=stereographic scale_to_hfov!:b=true custom_function? (c1?:d=1 c2?:d=1 c3?:d=0 f?:d=1
fun!:s=tan) cutoff_angle?:d=1.5707<0.0>3.141592653 env_texture_size?:i=256<4>2048 intrinsics?
(fx!:d=277 fy!:d=277 cx!:d=160 cy!:d=120 s!:d=0.0)) visibility_mask?:u=4294967295 &pose?)
#contact contact? (collision!:s=__default__ topic!:s=__default_topic__)
#forcetorque force_torque? (frame?:s=child measure_direction?:s=child_to_parent force? (x?
(&noise?) y? (&noise?) z? (&noise?)) torque? (x? (&noise?) y? (&noise?) z? (&noise?)))
#gps gps? (position_sensing? (horizontal? (&noise?) vertical? (&noise?)) velocity_sensing?
(horizontal? (&noise?) vertical? (&noise?)))
#imu imu? (orientation_reference_frame? (localization!:s=CUSTOM custom_rpy?:3='0 0 0'
@parent_frame?s='' grav_dir_x?:3='1 0 0' @parent_frame?s='') angular_velocity? (x? (&noise?) y?
(&noise?) z? (&noise?)) linear_acceleration? (x? (&noise?) y? (&noise?) z? (&noise?))
enable_orientation?:b=true)
#lidar lidar? (scan! (horizontal! (samples!:u=640 resolution!:d=1 min_angle!:d=0 max_angle!:d=0)
vertical? (samples!:u=1 resolution?:d=1 min_angle!:d=0 max_angle!:d=0)) range! (min!:d=0 max!:d=0
resolution?:d=0) noise? (type!:s=gaussian mean?:d=0.0 stddev?:d=0.0))
#logical_camera logical_camera? (near!:d=0 far!:d=1 aspect_ratio!:d=1 horizontal_fov!:d=1)
#magnetometer magnetometer? (x? (&noise?) y? (&noise?) z? (&noise?))
#navsat navsat?
#ray ray? (scan! (horizontal! (samples!:u=640 resolution!:d=1 min_angle!:d=0 max_angle!:d=0)
vertical? (samples!:u=1 resolution?:d=1 min_angle!:d=0 max_angle!:d=0)) range! (min!:d=0 max!:d=0
resolution?:d=0) noise? (type!:s=gaussian mean?:d=0.0 stddev?:d=0.0))
#rfid rfidtag?
#rfidtag rfid?
#sonar sonar? (geometry?:s=cone min!:d=0 max!:d=1.0 radius?:d=0.5)
#transceiver transceiver? (essid?:s=wireless frequency?:d=2442 min_frequency?:d=2412
max_frequency?:d=2484 gain!:d=2.5 power!:d=14.50 sensitivity?:d=-90)
#sensor sensor? @name!s=__default__ @type!s=__default__ (always_on?:b=false update_rate?:d=0
visualize?:b=false topic?:s=__default__ enable_metrics?:b=false &pose? &plugin* &air_pressure?
&altimeter? &camera? &contact? &forcetorque? &gps? &imu? &lidar? &logical_camera? &magnetometer?
&navsat? &ray? &rfid? &rfidtag? &sonar? &transceiver?)
#projector projector? @name!s=__default__ (texture!:s=__default__ fov?:d=0.785 near_clip?:d=0.1
far_clip?:d=10.0 &pose? &plugin*)
#audio_sink audio_sink*
#audio_source audio_source* (uri!:s=__default__ pitch?:d=1.0 gain?:d=1.0 contact?
(collision+:s=__default__) loop?:b=false &pose?)
#battery battery* @name!s=__default__ (voltage!:d=0.0)
#particle_emitter particle_emitter* @name!s=__default__ @type!s=point (emitting?:b=true
duration?:d=0 size?:3='1 1 1' particle_size?:3='1 1 1' lifetime?:d=5 rate?:d=10<0.0
min_velocity?:d=1<0.0 max_velocity?:d=1<0.0 scale_rate?:d=0<0.0 color_start?:c='1 1 1 1'
color_end?:c='1 1 1 1' color_range_image?:s='' topic?:s='' particle_scatter_ratio?:d=0.65 &pose?
&material?)
#link link* @name!s=__default__ (gravity?:b=true enable_wind?:b=false self_collide?:b=false
kinematic?:b=false must_be_base_link?:b=false velocity_decay? (linear?:d=0.0 angular?:d=0.0)
&pose? &inertial? &collision* &visual* &sensor* &projector* &audio_sink* &audio_source* &battery*
&light* &particle_emitter*)
#joint joint* @name!s=__default__ @type!s=__default__ (parent!:s=__default__ child!:s=__default__
gearbox_ratio?:d=1.0 gearbox_reference_body?:s=__default__ thread_pitch?:d=1.0 axis? (xyz!:3='0 0
1' @expressed_in?s='' dynamics? (damping?:d=0 friction?:d=0 spring_reference!:d=0
spring_stiffness!:d=0) limit! (lower!:d=-1e16 upper!:d=1e16 effort?:d=-1 velocity?:d=-1
stiffness?:d=1e8 dissipation?:d=1.0)) axis2? (xyz!:3='0 0 1' @expressed_in?s='' dynamics?
(damping?:d=0 friction?:d=0 spring_reference!:d=0 spring_stiffness!:d=0) limit! (lower?:d=-1e16
upper?:d=1e16 effort?:d=-1 velocity?:d=-1 stiffness?:d=1e8 dissipation?:d=1.0)) physics? (simbody?
(must_be_loop_joint?:b=false) ode? (cfm_damping?:b=false implicit_spring_damper?:b=false
fudge_factor?:d=0 cfm?:d=0 erp?:d=0.2 bounce?:d=0 max_force?:d=0 velocity?:d=0 limit? (cfm!:d=0.0
erp!:d=0.2) suspension? (cfm!:d=0.0 erp!:d=0.2)) provide_feedback?:b=false) &pose? &sensor*)
#gripper gripper* @name!s=__default__ (grasp_check? (detach_steps?:i=40 attach_steps?:i=20
min_contact_count?:u=2) gripper_link+:s=__default__ palm_link!:s=__default__)
#model model* @name!s=__default__ @canonical_link?s='' @placement_frame?s='' (static?:b=false
self_collide?:b=false allow_auto_disable?:b=true &frame* &pose? &link* &joint* &plugin* &gripper*
include* @merge?b=false (uri!:s=__default__ &pose? &plugin* name?:s='' static?:b=false
placement_frame?:s='') ^model* enable_wind?:b=false)
#actor actor* @name!s=__default__ (&pose? skin? (filename!:s=__default__ scale?:d=1.0) animation*
@name!s=__default__ (filename!:s=__default__ scale?:d=1.0 interpolate_x?:b=false) script!
(loop?:b=true delay_start?:d=0.0 auto_start?:b=true trajectory* @id!i=0 @type!s=__default__
@tension?d=0.0 (waypoint* (time!:d=0.0 pose!:p='0 0 0 0 0 0'))) &link+ &joint* &plugin*)
#road road* @name!s=__default__ (width!:d=1.0 point+:3='0 0 0' &material?)
#spherical_coordinates spherical_coordinates? (surface_model!:s=EARTH_WGS84
world_frame_orientation?:s=ENU latitude_deg!:d=0.0 longitude_deg!:d=0.0 elevation!:d=0.0
heading_deg!:d=0.0)
#link_state link* @name!s=__default__ (velocity?:p='0 0 0 0 0 0' acceleration?:p='0 0 0 0 0 0'
wrench?:p='0 0 0 0 0 0' collision* @name!s=__default__ &pose?)
#model_state model* @name!s=__default__ (joint* @name!s=__default__ (angle+:d=0 @axis!u=0)
^model_state* &frame* &pose? scale?:3='1 1 1' &link_state*)
#light_state light* @name!s=__default__ (&pose?)
#state state* @world_name!s=__default__ (sim_time?:t='0 0' wall_time?:t='0 0' real_time?:t='0 0'
iterations!:u=0 insertions? (&model+ &light+) deletions? (name+:s=__default__) &model_state*
&light_state*)
#population population* @name!s=__default__ (&box_shape? &cylinder_shape? model_count!:i=1
distribution! (type!:s=random rows?:i=1 cols?:i=1 step?:3='0.5 0.5 0') &pose? &model!)
#world world* @name!s=__default__ (audio? (device!:s=default) wind? (linear_velocity?:3='0 0 0')
include* (uri!:s=__default__ name?:s='' static?:b=false &pose? &plugin* placement_frame?:s='')
gravity!:3='0 0 -9.8' magnetic_field!:3='5.5645e-6 22.8758e-6 -42.3884e-6' &atmosphere! &gui?
&physics+ &scene! &light* &frame* &model* &actor* &plugin* &road* &spherical_coordinates? &state*
&population*)
#root sdf! @version!s=1.9 (&world* &model? &actor? &light?)
)";

}  // namespace kiva
