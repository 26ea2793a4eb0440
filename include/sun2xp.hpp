/// sun2xp.hpp - the calls of sun2xp.h for C++17: handles that close themselves, exceptions, arrays and durations.
///
/// This header has no library of its own: everything is inline, over the C interface. Most functions make the call of
/// sun2xp.h with the same name; the manual of the call is in sun2xp.h. A refused call throws sun2xp::error with the
/// number and the text of the refusal. The structs are those of sun2xp.h. This header sets the member `size` of each
/// struct.
///
///     sun2xp::hand hand = sun2xp::hand::named("nominal");
///     hand.finger(1).send_position({0.0, 0.5, 0.8});
///     hand.finger(1).wait(sun2xp::until::settled, std::chrono::seconds(5));
#ifndef SUN2XP_HPP
#define SUN2XP_HPP

#include "sun2xp.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace sun2xp {

/// Three numbers, for joints 0, 1 and 2 or along x, y and z. The manual of each call in sun2xp.h gives the unit.
using vector3 = std::array<double, 3>;

/// A matrix, row by row.
using matrix3 = std::array<std::array<double, 3>, 3>;

/// A duration in seconds. Every duration of std::chrono converts to it.
using seconds = std::chrono::duration<double>;

/// The number that stands for all fingers. Only functions that say so accept it.
inline constexpr int all_fingers = SUN2XP_ALL_FINGERS;

/// The condition of a wait.
enum class until { arrived = SUN2XP_WAIT_ARRIVED, settled = SUN2XP_WAIT_SETTLED };

/// A refused call.
class error : public std::runtime_error {
public:
    error(int number, int system_errno, const char *call, const char *text, const char *remedy)
        : std::runtime_error(text), number_(number), system_errno_(system_errno), call_(call), remedy_(remedy)
    {
    }

    /// The number of the refusal: a constant SUN2XP_ERROR_... of sun2xp.h.
    int number() const noexcept { return number_; }
    /// errno of the refusal.
    int system_errno() const noexcept { return system_errno_; }
    /// Name of the C call.
    const std::string &call() const noexcept { return call_; }
    /// C calls that help, separated by commas. The list names only calls that open or close a hand, sun2xp_recover,
    /// sun2xp_zero and sun2xp_status, so it may be empty although another call helps. what() always has the whole
    /// remedy.
    const std::string &remedy() const noexcept { return remedy_; }

private:
    int number_, system_errno_;
    std::string call_, remedy_;
};

namespace detail {

/// Throws the refusal of a call, or returns its result.
inline int checked(int result)
{
    if (result >= 0)
        return result;
    struct sun2xp_error refusal = {};
    refusal.size = sizeof refusal;
    ::sun2xp_error(nullptr, &refusal);
    throw error(-result, refusal.system_errno, refusal.call, refusal.text, refusal.remedy);
}

/// Returns a struct that a call has filled.
template <class Struct, class Call> Struct filled(Call call)
{
    Struct result = {};
    result.size = sizeof result;
    checked(call(&result));
    return result;
}

/// The limit of a wait, s. A time of 0 or less, for example because a deadline has passed, means that the call does not
/// wait. With a negative time, sun2xp_wait would refuse the call, and sun2xp_wait_event would wait without a limit.
inline double limit(seconds longest) noexcept { return longest.count() > 0 ? longest.count() : 0; }

/// A function that gets events.
using event_callback = std::function<void(const struct sun2xp_event &)>;

/// The event callbacks of all hands. Each callback has a number that is never used again. The library gets this number
/// and not the address of the callback, because a callback may be destroyed just when the library begins to call it: if
/// the callback of one hand removes the callback of another hand, sun2xp_on_event does not wait until the removed
/// callback has returned.
#if defined(__GNUC__)
// All shared objects of the process share one table, because a `hand` that was made in one shared object can be moved
// into another shared object.
class __attribute__((visibility("default"))) callbacks {
#else
class callbacks {
#endif
public:
    /// The table of the process. It is never destroyed, because the library may call callbacks until the process ends.
    static callbacks &all()
    {
        static callbacks *const all = new callbacks;
        return *all;
    }

    std::uintptr_t add(event_callback callback)
    {
        auto shared = std::make_shared<event_callback>(std::move(callback));
        const std::lock_guard<std::mutex> lock(mutex_);
        callbacks_.emplace(++last_, std::move(shared));
        return last_;
    }

    /// Removes the callback with this number. Its function object is destroyed when no call of it is running any more.
    void remove(std::uintptr_t number)
    {
        std::shared_ptr<event_callback> removed;
        const std::lock_guard<std::mutex> lock(mutex_);
        const auto found = callbacks_.find(number);
        if (found == callbacks_.end())
            return;
        // The destructor of the function may use other hands, so it must not run while the mutex is locked.
        removed = std::move(found->second);
        callbacks_.erase(found);
    }

    /// The callback with this number; null if it was removed.
    std::shared_ptr<event_callback> find(std::uintptr_t number)
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        const auto found = callbacks_.find(number);
        return found == callbacks_.end() ? nullptr : found->second;
    }

private:
    std::mutex mutex_;
    std::map<std::uintptr_t, std::shared_ptr<event_callback>> callbacks_;
    std::uintptr_t last_ = 0;
};

} // namespace detail

/// One finger of an open hand. It must not outlive the hand.
class finger {
public:
    finger(sun2xp_hand *hand, int number) noexcept : hand_(hand), number_(number) {}

    /// The number of the finger: 1 to 3, or all_fingers.
    int number() const noexcept { return number_; }

    vector3 position() const
    {
        vector3 result;
        detail::checked(sun2xp_position(hand_, number_, result.data()));
        return result;
    }

    void send_position(const vector3 &position)
    {
        detail::checked(sun2xp_send_position(hand_, number_, position.data()));
    }

    void send_position(const vector3 &position, seconds valid)
    {
        detail::checked(sun2xp_send_position_for(hand_, number_, position.data(), valid.count()));
    }

    void send_stiffness(const matrix3 &stiffness)
    {
        detail::checked(sun2xp_send_stiffness(hand_, number_, stiffness[0].data()));
    }

    void send_joint_stiffness(const matrix3 &stiffness)
    {
        detail::checked(sun2xp_send_joint_stiffness(hand_, number_, stiffness[0].data()));
    }

    void send_joint_torque(const vector3 &torque)
    {
        detail::checked(sun2xp_send_joint_torque(hand_, number_, torque.data()));
    }

    void send_tip(const vector3 &tip) { detail::checked(sun2xp_send_tip(hand_, number_, tip.data())); }

    void send_damping(double ratio) { detail::checked(sun2xp_send_damping(hand_, number_, ratio)); }

    void push(const vector3 &force) { detail::checked(sun2xp_push(hand_, number_, force.data())); }

    void adjust(const std::string &keys) { detail::checked(sun2xp_adjust(hand_, number_, keys.c_str())); }

    /// Sends a path. This function sets the member `size` of each pose.
    void send_path(std::vector<sun2xp_path_pose> poses, seconds valid = seconds(0))
    {
        for (sun2xp_path_pose &pose : poses)
            pose.size = sizeof pose;
        const int count = static_cast<int>(poses.size());
        detail::checked(sun2xp_send_path(hand_, number_, count, poses.data(), valid.count()));
    }

    struct sun2xp_status status() const
    {
        return detail::filled<struct sun2xp_status>([this](auto *to) { return ::sun2xp_status(hand_, number_, to); });
    }

    struct sun2xp_timing timing(int stage) const
    {
        const auto call = [this, stage](auto *to) { return ::sun2xp_timing(hand_, number_, stage, to); };
        return detail::filled<struct sun2xp_timing>(call);
    }

    struct sun2xp_tip tip() const
    {
        return detail::filled<struct sun2xp_tip>([this](auto *to) { return ::sun2xp_tip(hand_, number_, to); });
    }

    struct sun2xp_limits limits() const
    {
        return detail::filled<struct sun2xp_limits>([this](auto *to) { return ::sun2xp_limits(hand_, number_, to); });
    }

    struct sun2xp_fault fault() const
    {
        return detail::filled<struct sun2xp_fault>([this](auto *to) { return ::sun2xp_fault(hand_, number_, to); });
    }

    struct sun2xp_joint_torques joint_torques() const
    {
        const auto call = [this](auto *to) { return ::sun2xp_joint_torques(hand_, number_, to); };
        return detail::filled<struct sun2xp_joint_torques>(call);
    }

    struct sun2xp_palm_pose palm_pose() const
    {
        const auto call = [this](auto *to) { return ::sun2xp_palm_pose(hand_, number_, to); };
        return detail::filled<struct sun2xp_palm_pose>(call);
    }

    matrix3 jacobian() const
    {
        matrix3 result;
        detail::checked(sun2xp_jacobian(hand_, number_, nullptr, result[0].data()));
        return result;
    }

    vector3 forward_kinematics(const vector3 &position) const
    {
        vector3 tip;
        detail::checked(sun2xp_forward_kinematics(hand_, number_, position.data(), tip.data()));
        return tip;
    }

    vector3 inverse_kinematics(const vector3 &tip) const
    {
        vector3 position;
        detail::checked(sun2xp_inverse_kinematics(hand_, number_, tip.data(), position.data()));
        return position;
    }

    /// Waits until the condition holds. Returns false if it does not hold within the time, or if the hand is on another
    /// machine and its newest state is older than remote.stale_ms. With a time of 0 or less, returns at once. With an
    /// infinite time, waits without a limit. Accepts all_fingers.
    bool wait(until condition, seconds longest)
    {
        const int result = sun2xp_wait(hand_, number_, static_cast<int>(condition), detail::limit(longest));
        return result != -SUN2XP_ERROR_TIMED_OUT && detail::checked(result) == 0;
    }

    void zero() { detail::checked(sun2xp_zero(hand_, number_)); }
    void identify() { detail::checked(sun2xp_identify(hand_, number_)); }
    /// Accepts all_fingers.
    void recover() { detail::checked(sun2xp_recover(hand_, number_)); }
    /// Accepts all_fingers.
    void stop() { detail::checked(sun2xp_stop(hand_, number_)); }
    void write_black_box(const std::string &path)
    {
        detail::checked(sun2xp_write_black_box(hand_, number_, path.c_str()));
    }

    /// Installs a reflex. Returns the number of its rule.
    int install_reflex(sun2xp_reflex rule)
    {
        rule.size = sizeof rule;
        return detail::checked(sun2xp_install_reflex(hand_, number_, &rule));
    }

    /// Removes the rule with this number. The number 0 removes all rules of the finger.
    void remove_reflex(int rule) { detail::checked(sun2xp_remove_reflex(hand_, number_, rule)); }

private:
    sun2xp_hand *hand_;
    int number_;
};

/// An open hand. Its destructor closes it.
class hand {
public:
    /// A function that is called with each event of a hand, in a thread of the library. It must not throw. It may
    /// replace or remove itself with on_event, and may destroy the hand. The function object stays alive until the call
    /// returns. If the function removes the function of another hand, the removed function may still be running
    /// afterwards.
    using event_callback = detail::event_callback;

    /// Opens the hand of a configuration file.
    explicit hand(const std::string &path) { detail::checked(sun2xp_open(path.c_str(), &hand_)); }

    /// Opens the hand of the configuration file that OpenHand finds, or the simulated hand.
    static hand configured() { return hand([](sun2xp_hand **to) { return sun2xp_open(nullptr, to); }); }

    /// Opens the hand of a configuration in memory.
    static hand text(const std::string &configuration)
    {
        return hand([&](sun2xp_hand **to) { return sun2xp_open_text(configuration.c_str(), to); });
    }

    /// Opens a simulated hand: "nominal", "worn", "sheathed" or "cheap".
    static hand named(const std::string &name)
    {
        return hand([&](sun2xp_hand **to) { return sun2xp_open_named(name.c_str(), to); });
    }

    hand(hand &&other) noexcept
        : hand_(std::exchange(other.hand_, nullptr)), callback_(std::exchange(other.callback_, 0))
    {
    }

    /// Closes the hand that this object had, as its destructor does.
    hand &operator=(hand &&other) noexcept
    {
        // The swap gives `moved` the hand that this object had, and the destructor of `moved` closes it. An object that
        // is moved to itself keeps its hand.
        hand moved(std::move(other));
        std::swap(hand_, moved.hand_);
        std::swap(callback_, moved.callback_);
        return *this;
    }

    hand(const hand &) = delete;
    hand &operator=(const hand &) = delete;

    /// A refusal of sun2xp_close cannot be reported here. close() reports it.
    ~hand()
    {
        if (hand_ != nullptr)
            sun2xp_close(hand_);
        if (callback_ != 0)
            detail::callbacks::all().remove(callback_);
    }

    /// Closes the hand. After the refusal SUN2XP_ERROR_BUSY the hand is still open, and this object keeps its handle.
    void close()
    {
        // A callback may destroy this object as soon as the hand is closed.
        sun2xp_hand *const handle = std::exchange(hand_, nullptr);
        const int result = sun2xp_close(handle);
        if (result == -SUN2XP_ERROR_BUSY)
            hand_ = handle;
        detail::checked(result);
    }

    /// The handle, for calls of sun2xp.h.
    sun2xp_hand *handle() const noexcept { return hand_; }

    /// The finger with this number, 1 to 3. With all_fingers, the result stands for all fingers.
    class finger finger(int number) const noexcept { return {hand_, number}; }

    /// Commands several fingers in the same cycle. This function sets the member `size` of each set point.
    void send_group(std::vector<sun2xp_set_point> set_points)
    {
        for (sun2xp_set_point &set_point : set_points)
            set_point.size = sizeof set_point;
        detail::checked(sun2xp_send_group(hand_, static_cast<int>(set_points.size()), set_points.data()));
    }

    void set_gravity(const vector3 &gravity) { detail::checked(sun2xp_set_gravity(hand_, gravity.data())); }

    struct sun2xp_object object() const
    {
        return detail::filled<struct sun2xp_object>([this](auto *to) { return ::sun2xp_object(hand_, to); });
    }

    /// Takes the next event, if there is one.
    std::optional<struct sun2xp_event> next_event()
    {
        return event([this](struct sun2xp_event *to) { return sun2xp_next_event(hand_, to); });
    }

    /// Waits for an event. Returns std::nullopt if no event occurs within the time. With a time of 0 or less, returns
    /// at once. With an infinite time, waits without a limit.
    std::optional<struct sun2xp_event> wait_event(seconds longest)
    {
        const double limit = detail::limit(longest);
        return event([&](struct sun2xp_event *to) { return sun2xp_wait_event(hand_, to, limit); });
    }

    /// Calls a function with each event, in place of the previous function. An empty function ends the calls.
    void on_event(event_callback callback)
    {
        detail::callbacks &all = detail::callbacks::all();
        const std::uintptr_t next = callback ? all.add(std::move(callback)) : 0;
        // The number is stored first, because the function may be called, and replace itself, before this call returns.
        const std::uintptr_t previous = std::exchange(callback_, next);
        const int result = sun2xp_on_event(hand_, next != 0 ? &pass_on : nullptr, reinterpret_cast<void *>(next));
        // If the call is refused, the previous function stays.
        if (result != 0)
            callback_ = previous;
        all.remove(result == 0 ? previous : next);
        detail::checked(result);
    }

    /// A descriptor for poll and select.
    int event_descriptor() const { return detail::checked(sun2xp_event_descriptor(hand_)); }

private:
    template <class Open, class = decltype(std::declval<Open>()(nullptr))> explicit hand(Open open)
    {
        detail::checked(open(&hand_));
    }

    template <class Take> static std::optional<struct sun2xp_event> event(Take take)
    {
        struct sun2xp_event result = {};
        result.size = sizeof result;
        if (detail::checked(take(&result)) == 0)
            return std::nullopt;
        return result;
    }

    static void pass_on(const struct sun2xp_event *event, void *context) noexcept
    {
        const auto call = detail::callbacks::all().find(reinterpret_cast<std::uintptr_t>(context));
        if (call)
            (*call)(*event);
    }

    sun2xp_hand *hand_ = nullptr;
    /// The number of the function that gets the events; 0 if there is none.
    std::uintptr_t callback_ = 0;
};

/// Stops every finger of every hand of the process. It may be called in a signal handler.
inline void stop_all() noexcept { sun2xp_stop_all(); }

/// The text of a fault.
inline std::string fault_text(int number) { return sun2xp_fault_text(number); }

/// The version of the library that runs.
inline std::string version() { return sun2xp_version(); }

} // namespace sun2xp

#endif
